// Keeps a library's OpenMP to the calling thread.
#pragma once

#include <mutex>

namespace impinge {

/// While it lives, parallel regions that the calling thread enters run in that thread alone; afterwards as before.
/// Nothing where no OpenMP runtime is loaded. Other threads that want the same wait until then: Debian's serial OpenBLAS
/// hands out its working memory without a lock, and two factorizations at a time spoil each other.
///
/// Debian's libcholmod asks for four threads in each supernode, by a number compiled in: neither OMP_NUM_THREADS nor
/// our own thread count reaches it. On matrices of the size that bodies have they mostly wait for one another, and take
/// the processor from parallel_for. The bits are the same either way.
class SerialOpenMp {
 public:
  SerialOpenMp();
  ~SerialOpenMp();
  SerialOpenMp(const SerialOpenMp&) = delete;
  SerialOpenMp& operator=(const SerialOpenMp&) = delete;

 private:
  std::lock_guard<std::recursive_mutex> alone_;  // whoever has it may nest
  int levels_ = 0;                               // of nested parallel regions that were allowed
};

}  // namespace impinge
