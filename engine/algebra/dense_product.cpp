#include "engine/algebra/dense_product.hpp"

#include <algorithm>
#include <cstddef>

#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr int kPiece = 128;        // of k at a time: a tile's rows of A stay in the nearest cache
constexpr int kColumns = 48;       // of C a task
constexpr double kParallel = 1e6;  // multiplications below which waking a thread takes longer

struct Operands {
  const double *a, *b;
  double* c;
  int m, n, k;
  std::ptrdiff_t a_stride, b_stride, c_stride;
};

// numbers at a time; they stand anywhere in memory
struct Two {
  using Vector [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;
};
struct Four {
  using Vector [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
};
struct Eight {
  using Vector [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;
};

/// R vectors of rows by C columns of the result, kept in registers.
template <class Lanes, int R, int C>
[[gnu::always_inline]] inline void subtract_tile(const Operands& o, int i, int j0) {
  const double* const a = o.a + i;
  const double* const b = o.b + j0 * o.b_stride;
  double* const c = o.c + i + j0 * o.c_stride;
  using Vector = typename Lanes::Vector;
  constexpr int kWidth = sizeof(Vector) / sizeof(double);
  Vector sum[R][C];
#pragma GCC unroll 16
  for (int r = 0; r < R; ++r)
#pragma GCC unroll 16
    for (int j = 0; j < C; ++j) sum[r][j] = Vector{};
  for (int p = 0; p < o.k; ++p) {
    Vector row[R];
#pragma GCC unroll 16
    for (int r = 0; r < R; ++r) row[r] = *reinterpret_cast<const Vector*>(a + p * o.a_stride + r * kWidth);
#pragma GCC unroll 16
    for (int j = 0; j < C; ++j)
#pragma GCC unroll 16
      for (int r = 0; r < R; ++r) sum[r][j] += row[r] * b[p + j * o.b_stride];
  }
#pragma GCC unroll 16
  for (int r = 0; r < R; ++r)
#pragma GCC unroll 16
    for (int j = 0; j < C; ++j) *reinterpret_cast<Vector*>(c + j * o.c_stride + r * kWidth) -= sum[r][j];
}

template <class Lanes, int R, int C>
[[gnu::always_inline]] inline void subtract_rows(const Operands& o, int i) {
  int j = 0;
  for (; j + C <= o.n; j += C) subtract_tile<Lanes, R, C>(o, i, j);
  for (; j < o.n; ++j) subtract_tile<Lanes, R, 1>(o, i, j);
}

template <class Lanes, int R, int C>
[[gnu::always_inline]] inline void subtract(const Operands& o) {
  constexpr int kWidth = sizeof(typename Lanes::Vector) / sizeof(double);
  int i = 0;
  for (; i + R * kWidth <= o.m; i += R * kWidth) subtract_rows<Lanes, R, C>(o, i);
  for (; i + kWidth <= o.m; i += kWidth) subtract_rows<Lanes, 1, C>(o, i);
  for (; i + 2 <= o.m; i += 2) subtract_rows<Two, 1, C>(o, i);
  for (; i < o.m; ++i)
    for (int j = 0; j < o.n; ++j) {
      double sum = 0.0;
      for (int p = 0; p < o.k; ++p) sum += o.a[i + p * o.a_stride] * o.b[p + j * o.b_stride];
      o.c[i + j * o.c_stride] -= sum;
    }
}

void by_two(const Operands& o) { subtract<Two, 2, 4>(o); }

#if defined(__x86_64__)
[[gnu::target("avx2")]] void by_four(const Operands& o) { subtract<Four, 2, 6>(o); }
[[gnu::target("avx512f")]] void by_eight(const Operands& o) { subtract<Eight, 2, 8>(o); }

auto widest() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx512f") ? by_eight : __builtin_cpu_supports("avx2") ? by_four : by_two;
}
#else
auto widest() { return by_two; }
#endif

void in_pieces(Operands o) {
  static const auto kernel = widest();
  for (int left = o.k; left > 0; left -= kPiece, o.a += kPiece * o.a_stride, o.b += kPiece) {
    o.k = std::min(left, kPiece);
    kernel(o);
  }
}

}  // namespace

void subtract_product(DenseColumns a, DenseColumns b, double* c, int c_stride, int m, int n, int k) {
  if (m <= 0 || n <= 0 || k <= 0) return;
  const Operands all{a.first, b.first, c, m, n, k, a.stride, b.stride, c_stride};
  if (n <= kColumns || static_cast<double>(m) * n * k < kParallel) return in_pieces(all);
  parallel_for((n + kColumns - 1) / kColumns, 1, [&](std::size_t task) {
    Operands part = all;
    const auto first = static_cast<int>(task) * kColumns;
    part.n = std::min(kColumns, n - first);
    part.b += first * all.b_stride;
    part.c += first * all.c_stride;
    in_pieces(part);
  });
}

}  // namespace impinge
