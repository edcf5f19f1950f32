#include "engine/world/solve_tape.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/step/respond.hpp"

namespace impinge {
namespace {

/// To be tried: what solvers keep beside W stays the original's.
GroupSystem copy_of(const GroupSystem& system) {
  GroupSystem copy = system;
  copy.assembled.reset(), copy.between_nodes.reset();
  return copy;
}

}  // namespace

void SolveTape::begin(const Bodies& bodies, const ContactList& contacts, std::span<const CollisionGroup> groups,
                      std::optional<int> wanted) {
  bodies_ = &bodies;
  contacts_ = contacts;
  of_ = groups;
  wanted_ = wanted;
  groups_.assign(groups.size(), {});
}

SolveTape::Look SolveTape::look_at(GroupIndex group, const AssembledGroup& assembled, const GroupSystem& now,
                                   const GroupVerdict* verdict) const {
  Look look;
  for (std::size_t i = 0; i < assembled.contacts.size(); ++i) {
    const Collision* collision = contacts_.collision(assembled.contacts[i]);
    if (collision == nullptr) continue;
    const auto& [a, b] = assembled.points[i];
    SolvedContact contact = unsolved_contact(*collision, a, b, now.contacts[i].friction, *bodies_);
    if (i < now.lambda.size()) contact.lambda = now.lambda[i];
    contact.state = state_of(contact.lambda, contact.friction);
    contact.group = group;
    if (verdict != nullptr) contact.residual = verdict->of_contacts[i];
    look.contacts.push_back(std::move(contact));
  }
  return look;
}

void SolveTape::solving(GroupIndex group, const AssembledGroup& assembled, const Solving& how) {
  Group& mine = groups_[group];
  if (mine.solves++ == 0) {
    mine.start = look_at(group, assembled, assembled.system);
    for (const ContactRows& row : assembled.system.contacts)
      mine.rows += row.kind == RowKind::attachment ? 3 : row.has_one_row() ? 1 : 3;
  }
  const auto take = [&](const GroupSystem& now) {
    const GroupVerdict verdict = judge_group(now);
    mine.taken = look_at(group, assembled, now, &verdict);
    mine.taken->change =
        assembled.by_body(of_[group], now.delta_velocity, now.delta_angular_velocity, now.deformable_delta);
    mine.taken->residual = verdict.relative;
  };
  const auto solve = [&](GroupSystem& system, const ResponseContext& context) -> std::optional<ResponseResult> {
    try {
      return how.response.solve(system, how.lcp, context);
    } catch (const DivergenceError&) {  // so will the group itself
      return std::nullopt;
    }
  };

  GroupSystem trial = copy_of(assembled.system);
  ResponseContext context = how.context;
  int seen = 0;
  bool is_taken = false;
  context.observe = [&](const GroupSystem& now) {
    if (wanted_ && mine.looks + seen == *wanted_) take(now), is_taken = true;
    ++seen;
  };
  const std::optional<ResponseResult> result = solve(trial, context);
  if (!result) return;
  if (mine.solves == 1) mine.starts_at_zero = seen > 0;
  const bool has_loop = seen > 0;
  const int looks = has_loop ? seen : how.response.uses_cone_solver() ? result->iterations : 0;
  if (wanted_ && !is_taken && *wanted_ >= mine.looks) {
    const int iterations = *wanted_ - mine.looks + 1;
    if (!has_loop && iterations < looks) {  // what the solver comes to if it may make no more
      trial = copy_of(assembled.system);
      context = how.context;
      context.lcp.max_iterations = iterations;
      solve(trial, context);
    }
    take(trial);
  }
  mine.looks += looks;
}

int SolveTape::looks() const {
  int most = 0;
  for (const Group& group : groups_) most = std::max(most, group.looks);
  return most;
}

bool SolveTape::starts_at_zero() const {
  return std::any_of(groups_.begin(), groups_.end(), [](const Group& group) { return group.starts_at_zero; });
}

}  // namespace impinge
