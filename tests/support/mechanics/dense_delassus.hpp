// A Delassus operator stored as a dense matrix: the plainest one there is, to test solvers and other operators against.
#pragma once

#include "engine/lcp/cone_problem.hpp"

namespace impinge::test {

class DenseDelassus : public Delassus {
 public:
  explicit DenseDelassus(MatX w) : w_(std::move(w)), lambda_(VecX::Zero(w_.rows())) {
    for (Eigen::Index i = 0; i < w_.rows() / 3; ++i) diagonal_.push_back(w_.block<3, 3>(3 * i, 3 * i));
  }
  std::size_t contacts() const override { return diagonal_.size(); }
  const Mat3& diagonal(std::size_t i) const override { return diagonal_[i]; }
  void begin(const std::vector<Vec3>& lambda) override {
    for (std::size_t i = 0; i < lambda.size(); ++i) lambda_.segment<3>(3 * static_cast<Eigen::Index>(i)) = lambda[i];
  }
  Vec3 row(std::size_t i, bool) const override { return w_.middleRows<3>(3 * static_cast<Eigen::Index>(i)) * lambda_; }
  void change(std::size_t i, const Vec3& delta, bool) override {
    lambda_.segment<3>(3 * static_cast<Eigen::Index>(i)) += delta;
  }
  const MatX& matrix() const { return w_; }

 private:
  MatX w_;
  VecX lambda_;
  std::vector<Mat3> diagonal_;
};

}  // namespace impinge::test
