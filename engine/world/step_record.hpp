// What the model publishes after each frame, read-only: everything the view draws, the files report, the tests check.
// Everything in it belongs to one instant, the end of the frame.
#pragma once

#include <span>
#include <string_view>

#include "engine/bodies/attachment.hpp"
#include "engine/bodies/body_kind.hpp"
#include "engine/bodies/deformable_body.hpp"
#include "engine/contact/contact_frame.hpp"
#include "engine/contact/contact_state.hpp"
#include "engine/core/profile.hpp"
#include "engine/detection/collision.hpp"
#include "engine/ledger/frame_ledger.hpp"

namespace impinge {

struct BodyRecord {
  std::string_view name;
  BodyKind kind = BodyKind::dynamic;
  const Shape* shape = nullptr;
  Pose pose;                       ///< of the body's frame (centre of mass)
  Pose file_pose;                  ///< of the file's (or the shape's) own origin, without scale
  std::span<const Vec3> vertices;  ///< world vertices of a mesh; empty for an exact shape
  Aabb bounds;
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  double mass = 0.0;  ///< kg; 0 for static and scripted
  bool asleep = false;
  bool deleted = false;  ///< takes no part, and is not drawn
  struct Pulled {
    Vec3 point, target;  ///< metres
  };
  std::optional<Pulled> pull;  ///< by a hand
  GroupIndex group;            ///< of the last sub-step; none: nothing touches it
  /// of a deformable body: its tetrahedra, nodes, held nodes, embedding; its pose is its centre's
  const DeformableBody* deformable = nullptr;
};

/// A contact of the last sub-step, its points carried with their bodies to the end of the frame.
struct ContactRecord {
  BodyIndex body_a, body_b;
  TriangleIndex triangle_a, triangle_b;  ///< none: an exact shape
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero(), normal = Vec3::UnitY();
  double gap = 0.0;            ///< at the end of the frame, metres
  double gap0 = 0.0;           ///< what the solver saw, metres
  Vec3 lambda = Vec3::Zero();  ///< impulse (n, t1, t2) of the last sub-step, N·s
  double friction = 0.0;       ///< coefficient of the pair
  ContactState state = ContactState::open;
  GroupIndex group;
  std::uint64_t pair_id = 0;  ///< stable identity from step to step
  /// How far the last sub-step's answer is from Coulomb's law at this contact: its natural map as the judge measures it,
  /// by the largest velocity that the group's contacts had to answer. The largest of all is residual_coulomb.
  double residual = 0.0;
};

struct AttachmentRecord {
  std::string_view name;
  BodyIndex body_a, body_b;  ///< none: the world
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();
  Vec3 impulse = Vec3::Zero();  ///< on A, in the last sub-step, N·s
  AttachmentKind kind = AttachmentKind::point;
  Vec3 axis = Vec3::Zero();  ///< of a slide: unit, along the line, or the normal of the plane or surface at point_b
  int number = 0;            ///< in the scene's order
  /// How far A's point is from where it is held, metres.
  double error() const { return (point_a - point_b).norm(); }
};

/// Why a group's solve ended, the later the less it is an answer; the last is of methods whose work is fixed beforehand, and
/// claims nothing.
enum class SolveEnd : std::uint8_t { converged, cap, stalled, contradiction, refused, fixed };
constexpr SolveEnd kSolveEnds[] = {SolveEnd::converged,     SolveEnd::cap,     SolveEnd::stalled,
                                   SolveEnd::contradiction, SolveEnd::refused, SolveEnd::fixed};
std::string_view name_of(SolveEnd end);

/// The limit of a Newton scheme that its deformable bodies' motion has not come to the root of, in words.
inline constexpr std::string_view kRootLimit = "the Newton iterations of simulation.integrator";

/// Group solves that ended without an answer, by what ended them.
struct UnsolvedGroups {
  SolveEnd reason = SolveEnd::cap;
  std::string limit;  ///< of the cap: the path of the parameter that sets it, or in words where none does
  std::int64_t solves = 0;
};
/// Adds to the entry of the same reason and limit, or a new one at the end.
void count_unsolved(std::vector<UnsolvedGroups>& all, const UnsolvedGroups& more);

/// A body whose motion nobody vouches for, beside the other one that it may have passed.
struct UnsafeBody {
  enum Cause : std::uint8_t {
    unwatched,     ///< narrow_phase.continuous = "off"
    soft_contact,  ///< the response lets bodies overlap, so motions are not undone
    held_back,     ///< the sub-step was cut as often as it may be: the body stood still for the rest of it
    cut_limit      ///< the same, and the other body moved on all the same: nothing holds it
  };
  std::string name, other;
  Cause cause = unwatched;
  int substep = 0;  ///< of the frame, from 1
  double displacement =
      0.0;  ///< of the body in it, metres; of what is left of it where it was cut, and not gone if held back
  double approach = 0.0;    ///< of the two, metres
  double safe = 0.0;        ///< the approach that contacts see well, metres
  bool has_passed = false;  ///< it was looked for and found; else it only moved too far
};

/// Two bodies that overlap, as deep as a share of the thinner one's thickness.
struct Crossing {
  std::string a, b;
  double depth = 0.0, thickness = 0.0;  ///< metres
  int substep = 0;                      ///< of the frame, from 1; 0: its end
  double share() const { return thickness > 0.0 ? depth / thickness : 0.0; }
};

struct BodyShare;

/// A frame in numbers; what they mean: figures.cpp.
struct FrameStats {
  int frame = 0;
  double time = 0.0;
  int substeps = 0, bodies = 0, dofs = 0, asleep = 0;
  std::int64_t broad_pairs = 0, triangle_pairs = 0, contacts = 0, groups = 0;  ///< last sub-step
  double max_penetration = 0.0;  ///< metres, over contacts at the end of the frame
  double residual = 0.0;         ///< m/s, maximum over sub-steps and groups, by the judge
  std::int64_t lcp_iterations = 0, outer_iterations = 0;
  double substep_penetration = 0.0;  ///< metres, over contacts at the end of each sub-step
  std::int64_t unsafe_motions = 0;   ///< bodies that moved farther in a sub-step than contacts see, or passed another
  std::vector<UnsafeBody> unsafe;    ///< the first of each body; of frames that this process made
  std::int64_t self_crossings = 0;   ///< pairs of triangles of a deformable body's own surface, at the end
  double residual_coulomb = 0.0;     ///< natural map by max |J v* - bound|, maximum over sub-steps and groups
  SolveEnd ended = SolveEnd::converged;  ///< of the worst solve: without an answer, the largest residual_coulomb
  std::int64_t unconverged = 0;          ///< group solves of the frame that ended without an answer
  std::vector<UnsolvedGroups> unsolved;  ///< the same by cause; of frames that this process made
  double unsolved_residual = 0.0;        ///< their largest residual_coulomb
  int merged_impacts = 0;                ///< sub-steps in which more followed from one another than are told apart
  double attachment_error = 0.0;         ///< metres, over attachments at the end of the frame
  void take_unsolved(const UnsolvedGroups& cause, double residual);
  /// A solve of fixed work that is not within the tolerance.
  void take_fixed() { ended = unconverged == 0 ? SolveEnd::fixed : ended; }
  double kinetic = 0.0, potential = 0.0, elastic = 0.0;  ///< J
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
  void take(std::span<const BodyShare> shares);
  void take(const Balance& balance) {
    kinetic = balance.kinetic, potential = balance.potential, elastic = balance.elastic;
    momentum = balance.momentum, angular_momentum = balance.angular_momentum;
  }
  StageTimes times;
  std::uint64_t state_hash = 0;
  // Filled in by who asks the judge of overlap (judge.hpp).
  double judged_penetration = 0.0, judged_depth = 0.0;  ///< metres, see OverlapVerdict
  std::int64_t judged_intersections = 0;
  Crossing crossing;                          ///< the deepest by its share; of frames that this process made
  std::shared_ptr<const FrameLedger> ledger;  ///< with record.ledger; of frames that this process made
};

/// What a body adds to the figures of a frame. Of one that rests it stays the same; sums go over all in their order, so
/// that they are the same to the last bit whoever rests.
struct BodyShare {
  int bodies = 0, dofs = 0, asleep = 0;
  std::int64_t self_crossings = 0;
  Balance balance;
};

struct StepRecord {
  FrameStats stats;
  std::vector<BodyRecord> bodies;     ///< scene order
  std::vector<BodyPair> broad_pairs;  ///< what the broad phase let through
  std::vector<TrianglePair> triangle_pairs;
  std::vector<ContactRecord> contacts;
  std::vector<AttachmentRecord> attachments;
  std::vector<std::vector<BodyIndex>> groups;  ///< the bodies of each collision group, ascending
  Vec3 gravity = Vec3::Zero();
  double frame_time = 0.0;
};

}  // namespace impinge
