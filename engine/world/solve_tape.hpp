// The impulses of a response after each of its iterations. A copy of every group is solved under observation, so that
// the group itself is solved as if nobody looked on.
#pragma once

#include <optional>

#include "engine/step/group_result.hpp"
#include "engine/step/solve_watcher.hpp"

namespace impinge {

class SolveTape : public SolveWatcher {
 public:
  /// A group at one of its looks: one before the first iteration of each of its solves and one after each iteration. A
  /// solve that only its cone solver iterates has none before the first, and one that nothing iterates none at all.
  struct Look {
    std::vector<SolvedContact> contacts;  ///< of collisions
    std::vector<BodyVector> change;       ///< Δv by body of the group
    double residual = 0.0;                ///< of the judge, relative
  };
  struct Group {
    int solves = 0, looks = 0;
    bool starts_at_zero = false;  ///< the first look is before the first iteration
    int rows = 0;                 ///< of J
    Look start;                   ///< as assembled: with the impulses that it starts from
    std::optional<Look> taken;    ///< the look that was asked for, or the last of those that have fewer
  };

  /// The groups of a motion are about to be solved. `wanted`: a look, counted from 0; none: they are only counted.
  void begin(const Bodies& bodies, const ContactList& contacts, std::span<const CollisionGroup> groups,
             std::optional<int> wanted);
  void solving(GroupIndex group, const AssembledGroup& assembled, const Solving& how) override;

  const std::vector<Group>& groups() const { return groups_; }
  /// Of the group that has most.
  int looks() const;
  /// Whether the looks begin before the first iteration.
  bool starts_at_zero() const;

 private:
  Look look_at(GroupIndex group, const AssembledGroup& assembled, const GroupSystem& now,
               const GroupVerdict* verdict = nullptr) const;

  const Bodies* bodies_ = nullptr;
  ContactList contacts_;
  std::span<const CollisionGroup> of_;
  std::optional<int> wanted_;
  std::vector<Group> groups_;
};

}  // namespace impinge
