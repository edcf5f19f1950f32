// C -= A B, what dense factorizations spend their time on.
#pragma once

namespace impinge {

/// c (m × n) -= a (m × k) b (k × n), by columns with the leading dimension `stride` of all three. Each entry of A B is
/// summed in order of k, in pieces of fixed length, product and sum rounded by themselves: the same bits whatever vectors
/// the processor has and however many threads there are. Eigen's own, compiled for any x86-64, has two numbers at a time.
void subtract_product(const double* a, const double* b, double* c, int m, int n, int k, int stride);

}  // namespace impinge
