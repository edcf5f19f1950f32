// C -= A B, what dense factorizations spend their time on.
#pragma once

namespace impinge {

/// A matrix by columns: its first number, and how many from one column to the next.
struct DenseColumns {
  const double* first;
  int stride;
};

/// c (m × n, by columns) -= a (m × k) b (k × n). Each entry of A B is summed in order of k, in pieces of fixed length,
/// product and sum rounded by themselves: the same bits whatever vectors the processor has and however many threads there
/// are. Eigen's own, compiled for any x86-64, has two
/// numbers at a time; Debian's serial OpenBLAS is not safe among threads, nor always there.
void subtract_product(DenseColumns a, DenseColumns b, double* c, int c_stride, int m, int n, int k);

}  // namespace impinge
