// Whether the motion of a sub-step takes a surface through another. Contacts are found from where bodies stand; what moves
// farther than that search reaches may meet, and leave again, what it never had a contact with.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "engine/bodies/bodies.hpp"
#include "engine/bodies/time_integration.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/detection/continuous/passages.hpp"

namespace impinge {

/// Which motions are looked at.
enum class Continuous {
  when_needed,  ///< of pairs that approach by more than the search for contacts reaches
  on,           ///< of every pair with a mesh
  off
};

/// Pairs of bodies of which one passes through the other, in their order, each with its earliest passages. Twice the same
/// body: parts of it pass through each other.
struct UnsafeMotion {
  struct Pair {
    BodyIndex a, b;
    std::vector<Passage> passages;    ///< time: of the sub-step; none where nobody looked for them (Continuous::off)
    double way_a = 0.0, way_b = 0.0;  ///< how far the farthest moving point of each went, metres, or a bound of it
    double approach = 0.0;            ///< of the two at most, metres
    double safe = 0.0;                ///< the approach that contacts found before the motion see well, metres
  };
  std::vector<Pair> pairs;
};

/// What counts as a passage of two bodies.
using PassagesOf = std::function<PassageSettings(BodyIndex a, BodyIndex b)>;

/// By pair of rigid bodies: how deep they overlap where they stand, metres; 0: they don't.
using OverlapsOf = std::function<std::vector<double>(std::vector<BodyPair>)>;

class MotionGuard {
 public:
  MotionGuard();
  ~MotionGuard();
  /// Keeps where the sub-step begins.
  void open(const Bodies& bodies);
  /// Once velocities are final: how bodies that turn far get through the sub-step, which ends at `end`, s.
  void follow(Bodies& bodies, const TimeIntegration& how, double end);
  /// After the motion, of a body that was put back to where the sub-step began: it went nowhere.
  void stayed(BodyIndex body) { turns_[body].clear(); }
  /// After the motion: nothing if no surface passes another. Continuous::off: the pairs that nobody vouches for.
  /// `is_rough`: rigid bodies may end in one another by a tenth of the thinner one's thickness, from where contacts still
  /// know the way out. `is_cut`: of a sub-step that is made in pieces, whose overlaps add up. `overlaps`: rigid bodies that
  /// graze each other on the way of a whole one, and end no deeper in one another than is left to contacts, pass nobody;
  /// empty: every passage counts.
  std::optional<UnsafeMotion> look(const Bodies& bodies, Continuous which, const PassagesOf& settings, bool is_rough,
                                   bool is_cut, const OverlapsOf& overlaps);
  /// What `look` holds against each other of two bodies after the motion.
  struct PairMotion {
    bool is_planar = false;  ///< a plane is among them: what is through it is still inside
    bool meets = false;      ///< the boxes round their ways do
    double way_a = 0.0, way_b = 0.0, approach = 0.0, safe = 0.0;  ///< metres, as UnsafeMotion::Pair has them
    bool is_at_risk() const { return !is_planar && meets && approach > safe; }
  };
  PairMotion motion_of(const Bodies& bodies, BodyIndex a, BodyIndex b);
  /// For pairs that nobody vouches for: which of them pass, each by more than its safe approach.
  void find_passages(const Bodies& bodies, UnsafeMotion& motion, const PassagesOf& settings);

 private:
  enum class Depth { least, shallow, graze, rough, safe };  // from which on a passage counts
  struct Known;
  /// The box round everything the body covers on its way, and how far a point of it moves at most.
  struct Sweep {
    Aabb box;
    Vec3 shift = Vec3::Zero();  // of the centre; of a deforming body: none, its points stand for themselves
    double turn = 0.0;          // what its points do beside that, metres
    double way() const { return shift.norm() + turn; }
  };
  Sweep sweep_of(const Body& body, BodyIndex b) const;
  static double approach(const Sweep& a, const Sweep& b) { return (a.shift - b.shift).norm() + a.turn + b.turn; }
  void look_at_all(const Bodies& bodies);
  const PathSurface& surface_of(const Body& body);
  SurfacePath path_of(const Body& body, BodyIndex b);
  void add_self(const Bodies& bodies, Continuous which, std::vector<UnsafeMotion::Pair>& pairs);
  std::vector<UnsafeMotion::Pair> pairs_at_risk(const Bodies& bodies, Continuous which, bool is_rough);
  void search(const Bodies& bodies, std::vector<UnsafeMotion::Pair>& pairs, const PassagesOf& settings, Depth depth);
  void forgive_grazes(const Bodies& bodies, std::vector<UnsafeMotion::Pair>& pairs, const PassagesOf& settings,
                      const OverlapsOf& overlaps);

  std::vector<Pose> start_;               // by body
  std::vector<std::vector<Pose>> turns_;  // by body: poses on the way of what turns far; else empty
  std::vector<std::vector<Vec3>> nodes_;  // by body: where the vertices of deforming surfaces were
  std::vector<Sweep> sweeps_;             // by body
  std::vector<Aabb> boxes_;               // of the sweeps
  double least_ = 0.0;                    // of how far pairs may approach unseen, metres
  bool all_rigid_ = false;
  std::unique_ptr<BroadPhase> broad_phase_;
  std::map<const Shape*, Known> known_;
};

}  // namespace impinge
