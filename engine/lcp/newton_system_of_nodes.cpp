// Rigid bodies first, then the touched nodes of deformable ones: what the bodies' sparse matrix leaves of the nodes' is
// dense, and all that a dense LU is made of.
#include <Eigen/Cholesky>

#include "engine/algebra/dense_lu.hpp"
#include "engine/core/parallel.hpp"
#include "engine/lcp/body_matrix.hpp"
#include "engine/lcp/system_of_velocities.hpp"

namespace impinge {
namespace {

constexpr std::size_t kNodeColumnsPerTask = 8;

class SystemOfNodes : public SystemOfVelocities<NodeSpace> {
 public:
  explicit SystemOfNodes(const NodeSpace& space)
      : SystemOfVelocities(space, space.touches.size()),
        bodies_(space.bodies),
        free_(space.bodies),
        complement_(MatX::Zero(rows(), rows())) {
    for (const NodeSpace::Part& part : space.parts) {
      const Eigen::Index n = part.inverse->rows();
      complement_.block(3 * part.first, 3 * part.first, n, n) =
          part.inverse->selfadjointView<Eigen::Lower>().llt().solve(MatX::Identity(n, n));
    }
  }

 protected:
  void factorize_velocities(std::span<const Mat3> g) override {
    bodies_.factorize(g);
    g_.assign(g.begin(), g.end());
    by_node_ = couple();
    parallel_for(static_cast<std::size_t>(rows()) / kNodeColumnsPerTask + 1, 1, [&](std::size_t task) {
      VecX column;
      const auto first = static_cast<Eigen::Index>(task * kNodeColumnsPerTask);
      for (Eigen::Index c = first; c < std::min(rows(), first + Eigen::Index(kNodeColumnsPerTask)); ++c) {
        if (by_node_.col(c).isZero(0.0)) continue;
        column = by_node_.col(c);
        bodies_.solve(column);
        by_node_.col(c) = column;
      }
    });
    MatX m = complement_;
    for (std::size_t i = 0; i < g_.size(); ++i) add_contact(i, m);
    nodes_.compute(std::move(m));
  }

  void solve_velocities(VecX& s) const override {
    VecX bodies = s.head(space_.of_bodies()), nodes = s.tail(rows());
    if (bodies.size() > 0) bodies_.solve(bodies);
    for (std::size_t i = 0; i < g_.size(); ++i)
      if (!space_.touches[i].nodes.empty()) pull(i, Vec3(g_[i] * space_.bodies.relative(i, bodies)), nodes);
    nodes = nodes_.solve(nodes);
    s.head(space_.of_bodies()) = bodies - by_node_ * nodes;
    s.tail(rows()) = nodes;
  }

  void free_velocities(VecX& s) const override { space_.free_velocities(free_, s); }

 private:
  using Six = BodySpace::Six;
  Eigen::Index rows() const { return 3 * space_.touched; }

  /// What the bodies feel of the nodes: their columns of Jᵀ G J.
  MatX couple() const {
    MatX m = MatX::Zero(space_.of_bodies(), rows());
    for (std::size_t i = 0; i < g_.size(); ++i) {
      const NodeSpace::Touch& touch = space_.touches[i];
      if (touch.nodes.empty() || g_[i].isZero(0.0)) continue;
      const Mat3 by_velocity = g_[i] * touch.rows;
      for (const BodySpace::Side& side : space_.bodies.sides[i]) {
        if (side.body < 0) continue;
        for (const NodeSpace::Touch::Node& n : touch.nodes)
          for (int k = 0; k < 3; ++k)
            m.block<6, 3>(6 * side.body, 3 * n.place) += n.weight * side.row[k] * by_velocity.row(k);
      }
    }
    return m;
  }

  /// What contact i makes of the nodes' velocities at its own nodes, bodies following them.
  void add_contact(std::size_t i, MatX& m) const {
    const NodeSpace::Touch& touch = space_.touches[i];
    if (touch.nodes.empty() || g_[i].isZero(0.0)) return;
    const Mat3 to_nodes = touch.rows.transpose() * g_[i];
    const Mat3 own = to_nodes * touch.rows;
    for (const NodeSpace::Touch::Node& row : touch.nodes)
      for (const NodeSpace::Touch::Node& column : touch.nodes)
        m.block<3, 3>(3 * row.place, 3 * column.place) += row.weight * column.weight * own;
    for (const BodySpace::Side& side : space_.bodies.sides[i]) {
      if (side.body < 0) continue;
      Eigen::Matrix<double, 3, 6> j;
      for (int k = 0; k < 3; ++k) j.row(k) = side.row[k].transpose();
      const Eigen::Matrix<double, 3, Eigen::Dynamic> back = to_nodes * j * by_node_.middleRows<6>(6 * side.body);
      for (const NodeSpace::Touch::Node& row : touch.nodes) m.middleRows<3>(3 * row.place) -= row.weight * back;
    }
  }

  /// nodes -= J_iᵀ x.
  void pull(std::size_t i, const Vec3& x, VecX& nodes) const {
    const Vec3 force = space_.touches[i].rows.transpose() * x;
    for (const NodeSpace::Touch::Node& n : space_.touches[i].nodes) nodes.segment<3>(3 * n.place) -= n.weight * force;
  }

  BodyMatrix bodies_;
  InverseMasses free_;
  MatX complement_;  // K of the nodes
  std::vector<Mat3> g_;
  MatX by_node_;  // what the bodies' velocities take from the nodes'
  DenseLu nodes_;
};

}  // namespace

std::unique_ptr<NewtonSystem> newton_system_of_nodes(const NodeSpace& space) {
  return std::make_unique<SystemOfNodes>(space);
}

}  // namespace impinge
