#include "engine/world/pair_watch.hpp"

#include <algorithm>

#include "engine/world/world.hpp"

namespace impinge {

namespace {

bool is_among(const std::optional<UnsafeMotion>& unsafe, BodyIndex a, BodyIndex b) {
  return unsafe && std::any_of(unsafe->pairs.begin(), unsafe->pairs.end(),
                               [&](const UnsafeMotion::Pair& pair) { return pair.a == a && pair.b == b; });
}

/// Adds the contacts of the two that push, each as it was last. False: there are none.
bool take_pushing(const SubStep& step, BodyIndex a, BodyIndex b, std::map<std::uint64_t, Collision>& pushed) {
  bool is_pushed = false;
  for (const GroupResult& group : step.results)
    for (const SolvedContact& c : group.solved)
      if (c.collision.body_a == a && c.collision.body_b == b && !c.lambda.isZero(0.0))
        pushed.insert_or_assign(c.collision.feature, c.collision), is_pushed = true;
  return is_pushed;
}

}  // namespace

PairWatch::PairWatch(const World& world, BodyIndex first, BodyIndex second, std::optional<Asked> asked)
    : world_(world), a_(std::min(first, second)), b_(std::max(first, second)), asked_(asked) {}

void PairWatch::look_at_start() {
  world_.show_start(*this);
  has_contact_ = has_contact_now_;
  kept_ = std::move(now_);
  take(0);
}

void PairWatch::found(const Bodies&, const SubStep& step) {
  has_contact_now_ = std::any_of(step.collisions.begin(), step.collisions.end(),
                                 [&](const Collision& c) { return c.body_a == a_ && c.body_b == b_; });
  const auto may_be_nearer = [&] {
    const double gap = box_gap(step.colliders[a_].bounds, step.colliders[b_].bounds);
    return gap < nearest_distance_ || gap <= 0.0;  // boxes that overlap don't tell how deep
  };
  now_.reset();
  if (is_asked_for(world_.frame()) || (!first_contact_ && (has_contact_now_ || may_be_nearer() || !telling_)))
    now_ = pair_verdict(world_, step, a_, b_, search_);
}

void PairWatch::moved(const Bodies&, const SubStep& step, MotionGuard& guard, const std::optional<UnsafeMotion>& unsafe,
                      bool is_kept) {
  const Passage* passage = passage_of(unsafe, a_, b_);
  if (!is_kept) {
    if (passage != nullptr && undone_.motions++ == 0) undone_.first_time = step.time + passage->time * step.time_step;
    return;
  }
  ++pieces_;
  if (now_) now_->piece = pieces_;
  is_unsafe_ = is_unsafe_ || is_among(unsafe, a_, b_);
  if (now_) {
    now_->undone = undone_;
    add_outcome(*now_, world_, step, guard, passage);
    if (has_contact_now_ && !has_contact_) touching_ = now_;
    if (has_contact_now_ && take_pushing(step, a_, b_, pushed_)) pushing_ = now_;
  }
  has_contact_ = has_contact_ || has_contact_now_;
  kept_ = std::move(now_);
}

void PairWatch::finished(const Bodies&, int substep) { take(substep); }

void PairWatch::take(int substep) {
  const Moment here{world_.frame(), substep};
  // what pushed in an earlier piece is a contact of the sub-step, as its record has it
  if (kept_ && !kept_->in_contact() && pushing_) {
    kept_ = pushing_;
    kept_->contacts.clear();
    for (const auto& [feature, contact] : pushed_) kept_->contacts.push_back(contact);
  }
  for (std::optional<PairVerdict>* verdict : {&kept_, &touching_})
    if (*verdict) (*verdict)->substep = substep, (*verdict)->pieces = std::max(1, pieces_);
  if (has_contact_) {
    ++contacts_;
    last_contact_ = here;
    if (!first_contact_) first_contact_ = here, telling_ = touching_ ? touching_ : kept_;
  } else if (!first_contact_ && kept_) {
    const double distance = kept_->nearest ? kept_->nearest->distance : INFINITY;
    if (distance < nearest_distance_) nearest_ = here, nearest_distance_ = distance, telling_ = kept_;
    if (!telling_) telling_ = kept_;
  }
  if (kept_ && is_asked_for(here.frame) && (!asked_->substep || *asked_->substep == substep)) at_asked_ = kept_;
  if (is_unsafe_ && unsafe_motions_++ == 0) first_unsafe_ = here;
  is_unsafe_ = false;
  kept_.reset();
  touching_.reset(), pushing_.reset(), pushed_.clear();
  undone_ = {};
  pieces_ = 0;
  has_contact_ = false;
}

}  // namespace impinge
