// Cholesky factorization of dense columns, and the rows below them: what a sparse one does in each of its supernodes. The
// same bits whatever vectors the processor has and however many threads there are.
#pragma once

#include "engine/algebra/dense_product.hpp"

namespace impinge {

/// x (m × n, by columns) becomes x L⁻ᵀ; l: n × n, its lower triangle is looked at.
void solve_rows(DenseColumns l, int n, double* x, int x_stride, int m);

/// a (height × width by columns, height >= width) holds the lower trapezoid of a symmetric positive definite matrix: its
/// square top becomes L, the rows below x L⁻ᵀ. What stands above the diagonal is spoilt. False where a pivot is not
/// positive.
bool factorize_columns(double* a, int height, int width);

}  // namespace impinge
