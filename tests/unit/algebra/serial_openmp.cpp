#include "engine/algebra/serial_openmp.hpp"

#include <dlfcn.h>

#include <catch2/catch.hpp>

using namespace impinge;

TEST_CASE("OpenMP is kept to one thread for a while only, and whoever nests that gets back what there was") {
  const auto levels = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "omp_get_max_active_levels"));
  if (levels == nullptr) {
    WARN("not tested: no OpenMP runtime is loaded (built without CHOLMOD)");
    const SerialOpenMp serial;  // nothing to do, and nothing breaks
    return;
  }
  const int before = levels();
  CHECK(before > 0);
  {
    const SerialOpenMp serial;
    CHECK(levels() == 0);
    {
      const SerialOpenMp again;
      CHECK(levels() == 0);
    }
    CHECK(levels() == 0);
  }
  CHECK(levels() == before);
}
