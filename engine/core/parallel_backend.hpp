// Who carries out a parallel loop: oneTBB, or threads of our own (cmake -DIMPINGE_THREADS=std), which a thread sanitizer
// can look into (the packaged TBB is not instrumented). One of the two files is compiled.
#pragma once

#include <cstddef>
#include <functional>

namespace impinge::backend {

/// Forgets threads made for another number of them.
void reset();

/// body(i) for 0 <= i < count on `threads` threads, `grain` indices at a time.
void run(std::size_t count, std::size_t grain, int threads, const std::function<void(std::size_t)>& body);

}  // namespace impinge::backend
