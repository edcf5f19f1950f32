// A race on purpose: a thread sanitizer that does not find it here proves nothing elsewhere. Only the build with
// IMPINGE_SANITIZE=thread has this program; its test passes if the sanitizer's report names this file.
#include <cstdio>

#include "engine/core/parallel.hpp"

int main() {
  impinge::set_thread_count(4);
  long shared = 0;
  for (int round = 0; round < 20; ++round) impinge::parallel_for(100'000, 100, [&](std::size_t i) { shared += i; });
  std::printf("%ld\n", shared);
}
