#include "engine/lcp/cone_problem.hpp"

namespace impinge {

void Delassus::apply(const std::vector<Vec3>& x, std::vector<Vec3>& y) {
  begin(x);
  y.resize(contacts());
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = row(i, false);
}

MatX Delassus::dense() {
  const auto n = static_cast<Eigen::Index>(contacts());
  MatX w(3 * n, 3 * n);
  std::vector<Vec3> unit(contacts(), Vec3::Zero());
  for (Eigen::Index j = 0; j < 3 * n; ++j) {
    unit[j / 3][j % 3] = 1.0;
    begin(unit);
    for (Eigen::Index i = 0; i < n; ++i) w.block<3, 1>(3 * i, j) = row(i, false);
    unit[j / 3][j % 3] = 0.0;
  }
  begin(unit);
  return w;
}

Vec3 ConeProblem::nearest(std::size_t i, const Vec3& z) const {
  switch (kind_of(i)) {
    case RowKind::attachment:
      return z;
    case RowKind::sliding:
      return {z.x(), 0.0, 0.0};
    case RowKind::contact:
      break;
  }
  return project(z, mu[i], law);
}

Vec3 ConeProblem::dual(std::size_t i, const Vec3& u) const {
  if (has_one_row(i)) return {u.x(), 0.0, 0.0};
  return kind_of(i) == RowKind::attachment ? u : de_saxce(u, mu[i], law);
}

double ConeProblem::violation(std::size_t i, const Vec3& lambda) const {
  return kind_of(i) == RowKind::contact ? cone_violation(lambda, mu[i], law) : 0.0;
}

std::vector<int> rows_of(const ConeProblem& problem) {
  std::vector<int> rows;
  for (int i = 0; i < static_cast<int>(problem.q.size()); ++i)
    for (int k = 0; k < (problem.has_one_row(i) ? 1 : 3); ++k) rows.push_back(3 * i + k);
  return rows;
}

}  // namespace impinge
