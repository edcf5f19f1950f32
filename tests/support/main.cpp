#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include <cstdlib>

// volumes that tests make, here and in the programs they run, stay out of the user's cache
static const int kNoCache = setenv("IMPINGE_CACHE", "off", 0);
