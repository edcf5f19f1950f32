// What the response made of a group: a value. Groups don't see each other's, and whoever merges them does so in order.
#pragma once

#include <optional>

#include "engine/contact/assemble.hpp"
#include "engine/contact/contact_state.hpp"
#include "engine/core/profile.hpp"
#include "engine/frozen/frozen_step.hpp"
#include "engine/response/group_judge.hpp"

namespace impinge {

/// A contact of a sub-step in the coordinates of its bodies, so that its points can be carried to any later pose.
struct SolvedContact {
  Collision collision;
  MaterialPoint point_a, point_b;
  Vec3 local_normal = Vec3::Zero();  ///< in the frame of the body that owns the normal
  Vec3 lambda = Vec3::Zero();        ///< N·s
  double friction = 0.0;
  ContactState state = ContactState::open;
  GroupIndex group;
  double residual = 0.0;  ///< its own natural map, as the judge measures it (GroupVerdict::of_contacts)
};

inline ContactKey key_of(const Collision& c) { return {c.body_a, c.body_b, c.feature}; }

/// Of a body that moves so; `radius`: how far a rigid one reaches, metres. m/s.
double fastest_point(const BodyVector& velocity, double radius);

/// The largest part of a recovery that moves no point of a body faster than `most` allows; `fastest`: by body of the group,
/// m/s.
double share_of_push_out(const Bodies& bodies, const CollisionGroup& group, const Threshold& most, double gravity,
                         std::span<const double> fastest);

/// What a group's velocities are known to, m/s: a residual below it is rounding, and contradicts nothing. Speeds are rounded, and
/// positions where they stand: rows that take gaps or drifts back within Δt ask for that by Δt. So two points of a hinge, each a
/// last digit off its place, ask a rigid body to stretch.
double rounding_speed(const Bodies& bodies, const AssembledGroup& group, double time_step);

/// The collision at the bodies' present poses, not solved.
SolvedContact unsolved_contact(const Collision& collision, const MaterialPoint& a, const MaterialPoint& b,
                               double friction, const Bodies& bodies);

/// Its normal and its gap, metres, at the bodies' present poses.
Vec3 normal_of(const SolvedContact& contact, const Bodies& bodies);
double gap_of(const SolvedContact& contact, const Bodies& bodies);

/// What a row gave to its bodies, for the books (ledger/ledger.hpp).
struct RowImpulse {
  RowKind kind = RowKind::contact;
  BodyIndex body_a, body_b;  ///< none: the world
  ContactSide a, b;
  Vec3 normal = Vec3::Zero(),
       tangent = Vec3::Zero();  ///< its two parts on A, world axes, N·s; of attachments: all of it, 0
  Vec3 way_a = Vec3::Zero(), way_b = Vec3::Zero();  ///< of what meets in flight: how far either went until then, metres
};

struct GroupResult {
  // the answer, by body of the group
  std::vector<BodyVector> velocity;      ///< Δv
  std::vector<BodyVector> displacement;  ///< recovery from overlap, metres and radians; empty: none
  std::vector<char> struck;              ///< whose impulses are blows; empty: nobody's, or nobody has to know
  bool follows_flight = false;           ///< it is no recovery, but what the bodies went freely before they met
  std::optional<double> taken;           ///< energy that contact took, J, where the recovery is of a group that floats
  std::vector<double> push_out;          ///< how fast that is at each body's fastest point, m/s; empty: none

  // how it was found
  ResponseResult response;                   ///< of the last solve
  bool is_at_root = true;                    ///< false: a Newton scheme ended at its cap
  double root_residual = 0.0;                ///< what it left, by the forces and momenta that make it up
  bool is_contradiction = false;             ///< its rows have no answer
  bool is_provisional = false;               ///< roughly, and turns were not followed: contacts may still be added
  int iterations = 0, outer_iterations = 0;  ///< of all its solves
  GroupVerdict verdict;
  bool is_usable = true;  ///< answered, or of many rigid bodies nearly so
  bool is_answered() const { return response.converged() && is_at_root; }

  // what it hands on, by contact
  std::vector<ContactIndex> contacts;        ///< those that something responds to
  std::vector<ContactCache::Item> impulses;  ///< of each of them, zero ones too
  std::vector<Vec3> starts;                  ///< what each is to start from next time, likewise; empty: from these
  std::vector<SolvedContact> solved;         ///< of collisions, in order
  /// Where two meet in flight, likewise: A's velocity against B's then, before and after, (n, t1, t2), m/s; else empty.
  std::vector<std::pair<Vec3, Vec3>> slips;
  std::optional<FrozenGroup> frozen;    ///< where it was asked for
  std::vector<RowImpulse> rows;         ///< where it was asked for
  std::vector<BodyVector> row_impulse;  ///< with `rows`: J^T λ by body of the group, N·s and N·m·s
  double assemble_ms = 0.0, response_ms = 0.0;
};

/// Whether something without freedom holds the group; whether nothing does but its own rigid bodies one another; whether somebody
/// moves bodies of it by a motion of his own.
bool is_held(const Bodies& bodies, const CollisionGroup& group, const ContactList& contacts);
bool floats(const Bodies& bodies, const CollisionGroup& group, const ContactList& contacts);
bool is_driven(const Bodies& bodies, const CollisionGroup& group, const ContactList& contacts);

/// Whether a body of the group does not come to rest yet, by its free velocity without what gravity has given to it in the
/// sub-step.
bool is_on_its_way(const Bodies& bodies, const CollisionGroup& group, const Vec3& gravity, double time_step);

/// What the rows of a solved group gave, into `rows` and `row_impulse` of its result.
void keep_rows(const Bodies& bodies, const AssembledGroup& solved, const CollisionGroup& group,
               const ContactList& contacts, GroupResult& result);

/// What each contact of a solved group ends with, in order.
void keep_contacts(const Bodies& bodies, const AssembledGroup& solved, const ContactList& contacts, GroupIndex index,
                   GroupResult& result);

/// The answer of a frozen group, and where its rows act.
void keep_answer(const Bodies& bodies, const AssembledGroup& solved, const ContactList& contacts, FrozenGroup& frozen);

}  // namespace impinge
