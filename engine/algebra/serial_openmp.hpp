// Keeps a library's OpenMP to the calling thread.
#pragma once

namespace impinge {

/// While it lives, parallel regions that the calling thread enters run in that thread alone; afterwards as before.
/// Nothing where no OpenMP runtime is loaded.
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
  int levels_ = 0;  // of nested parallel regions that were allowed
};

}  // namespace impinge
