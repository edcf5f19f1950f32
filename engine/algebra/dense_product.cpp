#include "engine/algebra/dense_product.hpp"

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "engine/algebra/lanes.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr int kPiece = 128;        // of k at a time: a tile's rows of A stay in the nearest cache
constexpr int kColumns = 48;       // of C a task
constexpr int kWorthPacking = 32;  // rows and columns
constexpr double kParallel = 1e6;  // multiplications below which waking a thread takes longer

struct Operands {
  const double *a, *b;
  double* c;
  int m, n, k;
  std::ptrdiff_t a_stride, b_stride, c_stride;

  template <bool kTransposed>
  void to_column(int j) {
    b += kTransposed ? j : j * b_stride;
    c += j * c_stride;
  }
};

/// R vectors of rows by C columns of the result, kept in registers. a: their first column, a_step from one column to the
/// next; b: its number (p, j) stands at p b_step + j b_stride.
template <class Lanes, int R, int C>
[[gnu::always_inline]] inline void subtract_tile(const double* a, std::ptrdiff_t a_step, const double* b,
                                                 std::ptrdiff_t b_step, std::ptrdiff_t b_stride, double* c,
                                                 std::ptrdiff_t c_stride, int k) {
  using Vector = typename Lanes::Vector;
  Vector sum[R][C];
#pragma GCC unroll 16
  for (int r = 0; r < R; ++r)
#pragma GCC unroll 16
    for (int j = 0; j < C; ++j) sum[r][j] = Vector{};
  for (int p = 0; p < k; ++p) {
    Vector row[R];
#pragma GCC unroll 16
    for (int r = 0; r < R; ++r) load(row[r], a + p * a_step + r * kWidth<Lanes>);
#pragma GCC unroll 16
    for (int j = 0; j < C; ++j)
#pragma GCC unroll 16
      for (int r = 0; r < R; ++r) sum[r][j] += row[r] * b[p * b_step + j * b_stride];
  }
#pragma GCC unroll 16
  for (int r = 0; r < R; ++r)
#pragma GCC unroll 16
    for (int j = 0; j < C; ++j) {
      double* const to = c + j * c_stride + r * kWidth<Lanes>;
      Vector v;
      load(v, to);
      v -= sum[r][j];
      store(to, v);
    }
}

/// B as it stands.
template <bool kTransposed>
struct InPlace {
  const Operands& o;
  template <class Lanes, int R, int C>
  [[gnu::always_inline]] void subtract(const double* a, std::ptrdiff_t a_step, int i, int j) const {
    const std::ptrdiff_t step = kTransposed ? o.b_stride : 1, stride = kTransposed ? 1 : o.b_stride;
    subtract_tile<Lanes, R, C>(a, a_step, o.b + j * stride, step, stride, o.c + i + j * o.c_stride, o.c_stride, o.k);
  }
};

/// B copied tile by tile, each by its rows.
struct Packed {
  const Operands& o;
  const double* b;
  template <class Lanes, int R, int C>
  [[gnu::always_inline]] void subtract(const double* a, std::ptrdiff_t a_step, int i, int j) const {
    subtract_tile<Lanes, R, C>(a, a_step, b + static_cast<std::ptrdiff_t>(j) * o.k, C, 1, o.c + i + j * o.c_stride,
                               o.c_stride, o.k);
  }
};

/// Calls visit of each tile's first column and width, a constant.
template <int C, class Visit>
[[gnu::always_inline]] inline void each_tile(int n, Visit&& visit) {
  int j = 0;
  for (; j + C <= n; j += C) visit(j, std::integral_constant<int, C>());
  for (; j + 3 <= n; j += 3) visit(j, std::integral_constant<int, 3>());
  for (; j < n; ++j) visit(j, std::integral_constant<int, 1>());
}

template <class Lanes, int R, int C, class B>
[[gnu::always_inline]] inline void subtract_rows(const Operands& o, const B& b, int& i) {
  for (; i + R * kWidth<Lanes> <= o.m; i += R * kWidth<Lanes>)
    each_tile<C>(
        o.n, [&](int j, auto columns) __attribute__((always_inline)) {
          b.template subtract<Lanes, R, columns()>(o.a + i, o.a_stride, i, j);
        });
}

template <class Lanes, int R, int C, class B>
[[gnu::always_inline]] inline void subtract_rest(const Operands& o, const B& b, int i) {
  subtract_rows<Lanes, R, C>(o, b, i);
  subtract_rows<Lanes, 1, C>(o, b, i);
  subtract_rows<Two, 1, C>(o, b, i);
  subtract_rows<One, 1, C>(o, b, i);
}

template <bool kTransposed, int C>
[[gnu::always_inline]] inline void pack_columns(const Operands& o, double* to) {
  const std::ptrdiff_t step = kTransposed ? o.b_stride : 1, stride = kTransposed ? 1 : o.b_stride;
  each_tile<C>(
      o.n, [&](int j, auto columns) __attribute__((always_inline)) {
        const double* const from = o.b + j * stride;
        for (int p = 0; p < o.k; ++p)
          for (int c = 0; c < columns(); ++c) *to++ = from[p * step + c * stride];
      });
}

/// Copies put next to one another what is read again and again: far apart in memory, it drops out of the caches.
template <bool kTransposed, class Lanes, int R, int C>
[[gnu::always_inline]] inline void subtract(const Operands& o) {
  if (o.m < kWorthPacking || o.n < kWorthPacking || o.k < C)
    return subtract_rest<Lanes, R, C>(o, InPlace<kTransposed>{o}, 0);
  constexpr int kRows = R * kWidth<Lanes>;
  double columns_of_b[kColumns * kPiece], rows_of_a[kRows * kPiece];
  pack_columns<kTransposed, C>(o, columns_of_b);
  const Packed b{o, columns_of_b};
  int i = 0;
  for (; i + kRows <= o.m; i += kRows) {
    for (int p = 0; p < o.k; ++p)
      __builtin_memcpy(rows_of_a + p * kRows, o.a + i + p * o.a_stride, kRows * sizeof(double));
    each_tile<C>(
        o.n, [&](int j, auto columns)
                 __attribute__((always_inline)) { b.template subtract<Lanes, R, columns()>(rows_of_a, kRows, i, j); });
  }
  subtract_rest<Lanes, R, C>(o, b, i);
}

template <bool kTransposed>
void multiply_by_two(const Operands& o) {
  subtract<kTransposed, Two, 2, 4>(o);
}
template <bool kTransposed>
IMPINGE_FOUR_LANES void multiply_by_four(const Operands& o) {
  subtract<kTransposed, Four, 2, 6>(o);
}
template <bool kTransposed>
IMPINGE_EIGHT_LANES void multiply_by_eight(const Operands& o) {
  subtract<kTransposed, Eight, 2, 8>(o);
}

template <bool kTransposed>
void in_pieces(Operands o) {
  static const auto kernel =
      widest(multiply_by_two<kTransposed>, multiply_by_four<kTransposed>, multiply_by_eight<kTransposed>);
  for (int left = o.k; left > 0; left -= kPiece) {
    o.k = std::min(left, kPiece);
    kernel(o);
    o.a += kPiece * o.a_stride;
    o.b += kPiece * (kTransposed ? o.b_stride : 1);
  }
}

/// Calls strip(first column, columns), side by side where there is much to do.
template <class Strip>
void in_strips(int m, int n, int k, Strip&& strip) {
  const auto one = [&](std::size_t task) {
    const auto first = static_cast<int>(task) * kColumns;
    strip(first, std::min(kColumns, n - first));
  };
  const auto tasks = static_cast<std::size_t>((n + kColumns - 1) / kColumns);
  if (static_cast<double>(m) * n * k >= kParallel) return parallel_for(tasks, 1, one);
  for (std::size_t task = 0; task < tasks; ++task) one(task);
}

template <bool kTransposed>
void subtract_all(const Operands& all) {
  if (all.m <= 0 || all.n <= 0 || all.k <= 0) return;
  in_strips(all.m, all.n, all.k, [&](int first, int columns) {
    Operands part = all;
    part.n = columns;
    part.to_column<kTransposed>(first);
    in_pieces<kTransposed>(part);
  });
}

}  // namespace

void subtract_product(DenseColumns a, DenseColumns b, double* c, int c_stride, int m, int n, int k) {
  subtract_all<false>({a.first, b.first, c, m, n, k, a.stride, b.stride, c_stride});
}

void subtract_transposed(DenseColumns a, DenseColumns b, double* c, int c_stride, int m, int n, int k) {
  subtract_all<true>({a.first, b.first, c, m, n, k, a.stride, b.stride, c_stride});
}

void subtract_square(DenseColumns a, double* c, int c_stride, int m, int n, int k) {
  if (n <= 0 || k <= 0) return;
  in_strips(m, n, k, [&](int first, int columns) {
    Operands part{a.first + first, a.first, c + first, m - first, columns, k, a.stride, a.stride, c_stride};
    part.to_column<true>(first);
    in_pieces<true>(part);
  });
}

}  // namespace impinge
