// The contacts of a group of rigid bodies as sweeps read them again and again: numbers side by side and nothing else, in
// the order in which they are gone through. Directions, arms and mobilities are those of the sub-step's start; gaps are
// those of the points where the bodies have carried them since.
#pragma once

#include <optional>

#include "engine/contact/group_system.hpp"
#include "engine/core/threshold.hpp"
#include "engine/response/joint_system.hpp"
#include "engine/response/pair_colours.hpp"

namespace impinge {

/// Of a contact's spring over a solver step of implicit Euler, without a mass in it [Catto11].
struct SoftLaw {
  double bias_rate = 0.0;  ///< of the overlap that is taken out, 1/s
  double mass_scale = 1.0, impulse_scale = 0.0;
};
/// Of `hertz` and damping ratio `ratio` over `h` seconds.
SoftLaw soft_law(double hertz, double ratio, double h);

/// How a sweep answers.
struct SweepLaw {
  double time_step = 0.0;  ///< of a solver step, s: what gaps may be closed in
  double elapsed = 0.0;    ///< since the sub-step began, s: how long prescribed motions have moved their points
  bool recovers = false;   ///< whether overlap is taken out; else it may not grow
  SoftLaw between, fixed;  ///< of two that move; of one with a body that doesn't
};

class PackedContacts {
 public:
  /// `velocity_change`: what v* holds beside the velocities that the sub-step begins with. Solver steps
  /// start from this share of λ. Thresholds are parts of the speed of a contact's scale.
  PackedContacts(const GroupSystem& group, const Vec3& velocity_change, double share, const Threshold& max_push_out,
                 const Threshold& restitution_threshold);

  /// Whether nothing touches and every body is attached, so that one solve says all that many steps would come to.
  static bool is_only_joined(const GroupSystem& group);
  /// Bounces: the contacts of a pair that close in the sub-step faster than their threshold get what returns e of it, until
  /// none does, `most` rounds at most. Returns the rounds.
  int collide(const GroupSystem& group, const Vec3& velocity_change, double time_step, int most);
  /// All velocities change by this.
  void accelerate(const Vec3& change);
  /// Gives what the last solver step gave.
  void warm_start();
  void sweep(const SweepLaw& law);
  /// Positions by the velocities.
  void move(double time_step);
  /// Adds the impulses of this solver step to the sum.
  void close_step();
  /// λ, Δv, position velocities and the next start of the group, whose velocities have changed by `velocity_change` since
  /// the start.
  void write(GroupSystem& group, const Vec3& velocity_change, double moved_for) const;

 private:
  void write_positions(GroupSystem& group, double moved_for) const;
  /// By body: whether it is attached in points and touches nothing.
  std::vector<char> only_pinned() const;

  /// Three numbers: what compilers keep in registers, where a matrix library's vectors go through calls.
  struct Triple {
    double x = 0.0, y = 0.0, z = 0.0;
    friend double dot(const Triple& a, const Triple& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Triple cross(const Triple& a, const Triple& b) {
      return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    friend Triple sum(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Triple difference(const Triple& a, const Triple& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    /// Adds s b to a.
    friend void add(Triple& a, double s, const Triple& b) { a.x += s * b.x, a.y += s * b.y, a.z += s * b.z; }
    /// A symmetric matrix times v.
    friend Triple times(const double* m, const Triple& v) {
      return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
              m[2] * v.x + m[4] * v.y + m[5] * v.z};
    }
  };
  struct Body {
    Triple velocity, angular_velocity;
    Triple shift, turn;  // since the sub-step began
    double inverse_mass = 0.0, rounding = 0.0;
    double inverse_inertia[6] = {};  // xx, xy, xz, yy, yz, zz
  };
  struct Contact {
    Triple normal, arm_a, arm_b;
    Triple moment_a, moment_b;           // arm × normal
    Triple spin_a, spin_b;               // angular velocity that a unit of normal impulse makes
    double inverse_n, inverse_t;         // of the mobilities; 0: nothing can respond
    double gap, friction, max_push_out;  // at the start
    double bounces_from;                 // closing speed, m/s
    double impulse;                      // of this solver step, along the normal
    Triple tangent;                      // and across
  };
  /// Contacts that follow each other and are of the same two bodies.
  struct Pair {
    int a, b, first, count;
    bool is_driven;  // a prescribed motion is in it
  };
  /// A contact that bounces: how fast it is to part, m/s, and what it was given for that, N·s.
  struct Strike {
    int contact;
    double wanted, given;
    Triple before = {}, impulse = {};  // how fast its points slipped, all that it was given
  };
  /// All attachments and sliding points of the same two bodies, hard.
  struct JointRow {
    int row, k;  // in the group, and which of its three
    Triple direction, moment_a, moment_b;
    double surface;  // m/s, without what is asked for
  };
  struct Joint {
    int a, b;
    bool holds_points = false;
    std::vector<JointRow> rows = {};
    MatX inverse = {};
    VecX impulse = {}, sum = {};  // by row: of this solver step, of all
  };
  /// The two bodies of a pair as a sweep changes them; one that doesn't move stands in for none.
  struct Sides;

  void fill(const GroupSystem& group, std::size_t place, double share, const Threshold& max_push_out,
            const Threshold& restitution_threshold);
  void add_joints(const GroupSystem& group, double share);
  void add_joint(const GroupSystem& group, const JointBlock& block, double share);
  void strike(const Pair& pair, std::vector<Strike>& strikes, double slow);
  /// Of A's point from B's.
  Triple slip(const Pair& pair, int contact, const Sides& sides) const;
  void relax(const Pair& pair, const SweepLaw& law);
  double gap_of(const Pair& pair, int contact, const Sides& sides, double elapsed) const;
  /// Each by itself, or all at once where they share bodies.
  void relax_joints();
  /// Along its rows, less what is asked for.
  static VecX missing(const Joint& joint, std::vector<Body>& bodies);
  /// By joint: impulses that take from such velocities what joints miss.
  std::vector<VecX> answer_joints(std::vector<Body>& bodies) const;
  void add_impulse(Joint& joint, const VecX& change);
  /// What is only pinned moves otherwise than what touches: changes the velocities of positions so that joints between stay.
  void keep_joined(GroupSystem& group) const;
  void give(const Pair& pair);
  static void give(const Joint& joint, const VecX& impulse, std::vector<Body>& bodies);
  template <class Work>
  void for_each_pair(const Work& work);
  static Triple triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
  static Vec3 vector(const Triple& t) { return {t.x, t.y, t.z}; }

  std::vector<Body> bodies_;
  std::vector<Vec3> start_velocity_;  // of the bodies' centres
  std::vector<Pair> pairs_;           // colour by colour
  std::vector<int> colours_;          // where each begins, and the end
  bool last_is_rest_ = false;
  std::vector<Contact> contacts_;  // in the order of the pairs
  std::vector<int> rows_;          // of each, in the group
  std::vector<Triple> surface_;    // of each: prescribed velocity, world axes
  std::vector<double> sum_n_;      // of each: impulses of all solver steps
  std::vector<Triple> sum_t_;
  std::vector<Joint> joints_;
  std::optional<JointSystem> all_joints_;  // where some of them share a body
  int steps_ = 0;                          // closed
};

struct PackedContacts::Sides {
  Sides(std::vector<Body>& bodies, int a, int b) : a(a < 0 ? still_ : bodies[a]), b(b < 0 ? still_ : bodies[b]) {}

  /// Of the two points of arms from the centres, A against B.
  Triple velocity(const Triple& arm_a, const Triple& arm_b) const {
    return difference(sum(a.velocity, cross(a.angular_velocity, arm_a)),
                      sum(b.velocity, cross(b.angular_velocity, arm_b)));
  }
  void push(const Triple& arm_a, const Triple& arm_b, const Triple& impulse) {
    add(a.velocity, a.inverse_mass, impulse);
    add(a.angular_velocity, 1.0, times(a.inverse_inertia, cross(arm_a, impulse)));
    add(b.velocity, -b.inverse_mass, impulse);
    add(b.angular_velocity, -1.0, times(b.inverse_inertia, cross(arm_b, impulse)));
  }

 private:
  Body still_;

 public:
  Body &a, &b;
};

}  // namespace impinge
