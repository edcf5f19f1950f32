// A few columns at a time: those before are taken off by a product of matrices, and what is left of a row is solved for
// in registers.
#include "engine/algebra/dense_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/algebra/lanes.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr int kColumnsAtOnce = 48;   // whose products with those after them are taken at once
constexpr int kRows = 96;            // a task
constexpr double kSharedFrom = 1e6;  // multiplications below which waking a thread takes longer

/// Columns that a row is solved in at a time: nodes have three unknowns, and products are made of six columns.
int few(int left) { return left >= 6 ? 6 : left >= 3 ? 3 : 1; }

template <int N>
struct Triangle {
  double entry[N][N];  // [column][row]
  double inverse[N];   // of the diagonal

  explicit Triangle(DenseColumns l) {
    for (int j = 0; j < N; ++j) {
      for (int i = j; i < N; ++i) entry[j][i] = l.first[i + j * static_cast<std::ptrdiff_t>(l.stride)];
      inverse[j] = 1.0 / entry[j][j];
    }
  }
};

template <class Lanes, int N>
[[gnu::always_inline]] inline void solve_vectors(const Triangle<N>& l, double* x, std::ptrdiff_t stride, int m,
                                                 int& i) {
  for (; i + kWidth<Lanes> <= m; i += kWidth<Lanes>) {
    typename Lanes::Vector v[N];
#pragma GCC unroll 6
    for (int c = 0; c < N; ++c) {
      load(v[c], x + i + c * stride);
#pragma GCC unroll 6
      for (int d = 0; d < c; ++d) v[c] -= v[d] * l.entry[d][c];
      v[c] *= l.inverse[c];
      store(x + i + c * stride, v[c]);
    }
  }
}

template <class Lanes, int N>
[[gnu::always_inline]] inline void solve_few(const Triangle<N>& l, double* x, std::ptrdiff_t stride, int m) {
  int i = 0;
  solve_vectors<Lanes>(l, x, stride, m, i);
  for (; i < m; ++i)
    for (int c = 0; c < N; ++c) {
      double v = x[i + c * stride];
      for (int d = 0; d < c; ++d) v -= x[i + d * stride] * l.entry[d][c];
      x[i + c * stride] = v * l.inverse[c];
    }
}

template <int N>
void solve_by_two(const Triangle<N>& l, double* x, std::ptrdiff_t stride, int m) {
  solve_few<Two>(l, x, stride, m);
}
template <int N>
IMPINGE_FOUR_LANES void solve_by_four(const Triangle<N>& l, double* x, std::ptrdiff_t stride, int m) {
  solve_few<Four>(l, x, stride, m);
}
template <int N>
IMPINGE_EIGHT_LANES void solve_by_eight(const Triangle<N>& l, double* x, std::ptrdiff_t stride, int m) {
  solve_few<Eight>(l, x, stride, m);
}

template <int N>
void solve_columns(DenseColumns l, double* x, std::ptrdiff_t stride, int m) {
  static const auto kernel = widest(solve_by_two<N>, solve_by_four<N>, solve_by_eight<N>);
  if (m > 0) kernel(Triangle<N>(l), x, stride, m);
}

void solve_columns(DenseColumns l, int n, double* x, std::ptrdiff_t stride, int m) {
  if (n == 6) return solve_columns<6>(l, x, stride, m);
  if (n == 3) return solve_columns<3>(l, x, stride, m);
  solve_columns<1>(l, x, stride, m);
}

const double* at(DenseColumns l, int row, int column) {
  return l.first + row + column * static_cast<std::ptrdiff_t>(l.stride);
}

/// n <= kColumnsAtOnce.
void solve_block(DenseColumns l, int n, double* x, int x_stride, int m) {
  const std::ptrdiff_t stride = x_stride;
  for (int j = 0, count = 0; j < n; j += count) {
    count = few(n - j);
    subtract_transposed({x, x_stride}, {at(l, j, 0), l.stride}, x + j * stride, x_stride, m, count, j);
    solve_columns({at(l, j, j), l.stride}, count, x + j * stride, stride, m);
  }
}

/// n <= 6.
bool factorize_few(double* a, std::ptrdiff_t stride, int n) {
  for (int j = 0; j < n; ++j) {
    double pivot = a[j + j * stride];
    for (int p = 0; p < j; ++p) pivot -= a[j + p * stride] * a[j + p * stride];
    if (!(pivot > 0.0)) return false;
    const double diagonal = a[j + j * stride] = std::sqrt(pivot);
    for (int i = j + 1; i < n; ++i) {
      double sum = a[i + j * stride];
      for (int p = 0; p < j; ++p) sum -= a[i + p * stride] * a[j + p * stride];
      a[i + j * stride] = sum / diagonal;
    }
  }
  return true;
}

/// A square block of n <= kColumnsAtOnce, or one with rows below that are too few to share.
bool factorize_block(double* a, int height, int n, int stride) {
  for (int j = 0, count = 0; j < n; j += count) {
    count = few(n - j);
    double* const column = a + j * static_cast<std::ptrdiff_t>(stride);
    subtract_transposed({a + j, stride}, {a + j, stride}, column + j, stride, height - j, count, j);
    if (!factorize_few(column + j, stride, count)) return false;
    solve_columns({column + j, stride}, count, column + j + count, stride, height - j - count);
  }
  return true;
}

/// The rows of x on all cores.
void solve_rows_apart(DenseColumns l, int n, double* x, int x_stride, int m) {
  const auto tasks = static_cast<std::size_t>((m + kRows - 1) / kRows);
  parallel_for(tasks, 1, [&](std::size_t task) {
    const auto first = static_cast<int>(task) * kRows;
    solve_block(l, n, x + first, x_stride, std::min(kRows, m - first));
  });
}

}  // namespace

void solve_rows(DenseColumns l, int n, double* x, int x_stride, int m) {
  for (int j = 0; j < n; j += kColumnsAtOnce) {
    const int count = std::min(kColumnsAtOnce, n - j), after = j + count;
    double* const block = x + j * static_cast<std::ptrdiff_t>(x_stride);
    solve_block({at(l, j, j), l.stride}, count, block, x_stride, m);
    subtract_transposed({block, x_stride}, {at(l, after, j), l.stride},
                        x + after * static_cast<std::ptrdiff_t>(x_stride), x_stride, m, n - after, count);
  }
}

bool factorize_columns(double* a, int height, int width) {
  for (int j = 0; j < width; j += kColumnsAtOnce) {
    const int count = std::min(kColumnsAtOnce, width - j), after = j + count;
    double* const block = a + j + j * static_cast<std::ptrdiff_t>(height);
    const bool shared = static_cast<double>(height - after) * count * count >= kSharedFrom;
    if (!factorize_block(block, shared ? count : height - j, count, height)) return false;
    if (shared) solve_rows_apart({block, height}, count, block + count, height, height - after);
    subtract_square({block + count, height}, a + after + after * static_cast<std::ptrdiff_t>(height), height,
                    height - after, width - after, count);
  }
  return true;
}

}  // namespace impinge
