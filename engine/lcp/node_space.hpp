// The factors of a Delassus operator where rigid bodies and deformable ones meet, W = J K⁻¹ Jᵀ: six velocities a rigid
// body and three a node that contacts touch. Of a deformable body K⁻¹ is A⁻¹ between those nodes: its other nodes have
// been eliminated, K is their Schur complement in A.
#pragma once

#include "engine/lcp/body_space.hpp"

namespace impinge {

struct NodeSpace {
  /// A contact's columns at touched nodes: weight times the directions of the rows that it has.
  struct Touch {
    struct Node {
      int place = 0;        ///< among all that are touched
      double weight = 0.0;  ///< with the side's sign
    };
    Mat3 rows = Mat3::Zero();
    std::vector<Node> nodes;
  };
  /// Of one deformable body.
  struct Part {
    int first = 0;                  ///< place of its first touched node
    const MatX* inverse = nullptr;  ///< A⁻¹ between them, 1/kg; whoever made the space keeps it
  };

  BodySpace bodies;            ///< the rigid ones
  std::vector<Touch> touches;  ///< by contact
  std::vector<Part> parts;
  int touched = 0;  ///< nodes

  Eigen::Index of_bodies() const { return static_cast<Eigen::Index>(6 * bodies.mass.size()); }
  /// Those of the bodies, then those of the nodes.
  VecX no_velocities() const { return VecX::Zero(of_bodies() + 3 * touched); }

  /// s += J_iᵀ x.
  void push(std::size_t i, const Vec3& x, VecX& s) const {
    bodies.push(i, x, s);
    if (touches[i].nodes.empty()) return;
    const Vec3 force = touches[i].rows.transpose() * x;
    for (const Touch::Node& n : touches[i].nodes) s.segment<3>(of_bodies() + 3 * n.place) += n.weight * force;
  }
  /// J_i s.
  Vec3 relative(std::size_t i, const VecX& s) const {
    Vec3 velocity = Vec3::Zero();
    for (const Touch::Node& n : touches[i].nodes) velocity += n.weight * s.segment<3>(of_bodies() + 3 * n.place);
    return bodies.relative(i, s) + touches[i].rows * velocity;
  }
  /// s = K⁻¹ s.
  void free_velocities(const InverseMasses& masses, VecX& s) const {
    masses.apply(s);
    for (const Part& part : parts) {
      auto of_part = s.segment(of_bodies() + 3 * part.first, part.inverse->rows());
      of_part = VecX(*part.inverse * of_part);
    }
  }
};

}  // namespace impinge
