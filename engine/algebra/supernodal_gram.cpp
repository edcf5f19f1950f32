// With Y = L⁻¹ P B, Bᵀ A⁻¹ B = Yᵀ Y: half of the triangular solves, and symmetric by itself. Y is never stored. The
// supernodes (blocks of columns of L with the same rows below) are taken from the leaves of the elimination tree to its
// root as in a multifrontal factorization: each gathers the parts of B in its own rows and what its children have left
// for it, solves for its rows of Y, adds their products to W and hands the rest on. A supernode works on those columns
// of B only that reach it, which is where sparse columns save: a contact on the surface touches one path from a leaf to
// the root.
#ifdef IMPINGE_CHOLMOD

#include "engine/algebra/supernodal_gram.hpp"

#include <algorithm>
#include <numeric>

#include "engine/core/interrupt.hpp"

// of the BLAS that CHOLMOD itself uses
extern "C" {
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m, const int* n,
            const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void dgemm_(const char* trans_a, const char* trans_b, const int* m, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c,
            const int* ldc);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha, const double* a,
            const int* lda, const double* beta, double* c, const int* ldc);
}

namespace impinge {
namespace {

/// One supernode of the factor: columns first … first + width − 1, its rows (those columns, then those below).
struct Supernode {
  int first, width, height;
  const int* rows;
  const double* values;  // height × width, lower trapezoid
};

Supernode supernode(const cholmod_factor& l, int s) {
  const int* start = static_cast<const int*>(l.super);
  const int* rows = static_cast<const int*>(l.pi);
  return {start[s], start[s + 1] - start[s], rows[s + 1] - rows[s], static_cast<const int*>(l.s) + rows[s],
          static_cast<const double*>(l.x) + static_cast<const int*>(l.px)[s]};
}

/// What a supernode leaves for those above: one row for each of its rows below, one column for each column of B that
/// has reached it.
struct Left {
  std::vector<int> columns;  // ascending
  MatX values;
};

struct Entry3 {
  int row, column;
  double value;
};

/// B's entries by row of the permuted system.
std::vector<Entry3> permuted_entries(const cholmod_factor& l, const SparseColumns& b) {
  const int n = static_cast<int>(l.n);
  const int* permutation = static_cast<const int*>(l.Perm);
  std::vector<int> place(n);
  for (int i = 0; i < n; ++i) place[permutation[i]] = i;
  std::vector<Entry3> entries;
  entries.reserve(b.nonZeros());
  for (int j = 0; j < b.outerSize(); ++j)
    for (SparseColumns::InnerIterator it(b, j); it; ++it) entries.push_back({place[it.row()], j, it.value()});
  std::stable_sort(entries.begin(), entries.end(), [](const Entry3& p, const Entry3& q) { return p.row < q.row; });
  return entries;
}

void add_product(const MatX& y, int width, const std::vector<int>& columns, MatX& w, MatX& scratch) {
  const int count = static_cast<int>(columns.size()), height = static_cast<int>(y.rows());
  const double one = 1.0, zero = 0.0;
  if (count == w.cols()) {
    dsyrk_("L", "T", &count, &width, &one, y.data(), &height, &one, w.data(), &count);
    return;
  }
  scratch.resize(count, count);
  dsyrk_("L", "T", &count, &width, &one, y.data(), &height, &zero, scratch.data(), &count);
  for (int j = 0; j < count; ++j)
    for (int i = j; i < count; ++i) w(columns[i], columns[j]) += scratch(i, j);
}

}  // namespace

void supernodal_gram(const cholmod_factor& l, const SparseColumns& b, MatX& w) {
  const int count = static_cast<int>(l.nsuper);
  std::vector<int> owner(l.n);
  for (int s = 0; s < count; ++s) {
    const Supernode node = supernode(l, s);
    std::fill_n(owner.begin() + node.first, node.width, s);
  }
  w.setZero(b.cols(), b.cols());
  const std::vector<Entry3> entries = permuted_entries(l, b);
  std::vector<std::vector<int>> children(count);  // those with something left
  std::vector<Left> left(count);
  std::vector<int> local_row(l.n), local_column(b.cols(), -1);
  MatX front, scratch;
  std::size_t next = 0;
  for (int s = 0; s < count; ++s) {
    const Supernode node = supernode(l, s);
    const std::size_t begin = next;
    while (next < entries.size() && entries[next].row < node.first + node.width) ++next;

    std::vector<int> columns;
    const auto add_column = [&](int c) {
      if (local_column[c] >= 0) return;
      local_column[c] = 0;
      columns.push_back(c);
    };
    for (std::size_t e = begin; e < next; ++e) add_column(entries[e].column);
    for (const int child : children[s])
      for (const int c : left[child].columns) add_column(c);
    if (columns.empty()) continue;
    check_interrupt();
    std::sort(columns.begin(), columns.end());
    const int active = static_cast<int>(columns.size());
    for (int i = 0; i < active; ++i) local_column[columns[i]] = i;
    for (int i = 0; i < node.height; ++i) local_row[node.rows[i]] = i;

    front.setZero(node.height, active);
    for (std::size_t e = begin; e < next; ++e)
      front(entries[e].row - node.first, local_column[entries[e].column]) += entries[e].value;
    for (const int child : children[s]) {
      const Supernode from = supernode(l, child);
      Left& part = left[child];
      const int* rows = from.rows + from.width;
      for (std::size_t j = 0; j < part.columns.size(); ++j) {
        double* out = front.col(local_column[part.columns[j]]).data();
        const double* in = part.values.col(static_cast<Eigen::Index>(j)).data();
        for (int i = 0; i < part.values.rows(); ++i) out[local_row[rows[i]]] += in[i];
      }
      part = {};
    }
    for (const int c : columns) local_column[c] = -1;

    const double one = 1.0, minus = -1.0;
    dtrsm_("L", "L", "N", "N", &node.width, &active, &one, node.values, &node.height, front.data(), &node.height);
    add_product(front, node.width, columns, w, scratch);
    const int below = node.height - node.width;
    if (below == 0) continue;
    dgemm_("N", "N", &below, &active, &node.width, &minus, node.values + node.width, &node.height, front.data(),
           &node.height, &one, front.data() + node.width, &node.height);
    left[s].values = front.bottomRows(below);
    left[s].columns = std::move(columns);
    children[owner[node.rows[node.width]]].push_back(s);
  }
  w.triangularView<Eigen::StrictlyUpper>() = w.transpose();
}

}  // namespace impinge

#endif
