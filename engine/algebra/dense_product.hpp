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
/// are. Eigen's own, compiled for any x86-64, has two numbers at a time; OpenBLAS has other bits on other processors.
void subtract_product(DenseColumns a, DenseColumns b, double* c, int c_stride, int m, int n, int k);
/// The same with b transposed: it stands as n × k.
void subtract_transposed(DenseColumns a, DenseColumns b, double* c, int c_stride, int m, int n, int k);
/// c (m × n, n <= m) -= a (m × k) times the transpose of its first n rows, below the diagonal and on it; what stands
/// above is spoilt in places.
void subtract_square(DenseColumns a, double* c, int c_stride, int m, int n, int k);

}  // namespace impinge
