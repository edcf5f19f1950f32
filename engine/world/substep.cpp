// A sub-step, in one piece or, where a surface would pass through another, in several: each ends shortly before a meeting,
// so that the next one finds contacts where they are. What is met from so close by gets contacts of its own. What would
// still pass when the sub-step has been cut as often as it may be stays where it stands: it loses time, and is named.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "engine/bodies/scale.hpp"
#include "engine/contact/pair_scale.hpp"
#include "engine/ledger/ledger.hpp"
#include "engine/shapes/sheet.hpp"
#include "engine/step/cuts/piece_lengths.hpp"
#include "engine/step/cuts/piece_start.hpp"
#include "engine/step/end_pose.hpp"
#include "engine/step/impacts.hpp"
#include "engine/step/remember.hpp"
#include "engine/step/step_watcher.hpp"
#include "engine/world/world.hpp"

namespace impinge {
namespace {

constexpr int kMostPieces = 64;        // of a sub-step
constexpr int kMostMotions = 32;       // tried for a piece
constexpr int kPatience = 4;           // motions after which pieces are cut shorter than they need be
constexpr int kPatienceWithMany = 2;   // the same without fewer pairs that pass, where many do
constexpr std::size_t kMany = 4;       // pairs
constexpr double kMuchShorter = 0.25;  // what is cut then
constexpr double kGrowth = 2.0;        // of the next piece over one that had rows and took more motions than that
constexpr double kAfterCut = 16.0;     // of the next piece over one that was cut on a long way
constexpr double kLongWay = 4.0;       // of a safe approach
constexpr double kNoShare = 1e-9;      // of a motion: no time passes in less, and no velocity follows from that
constexpr double kLeastShare = 1e-4;   // of a sub-step, that a piece is tried with
constexpr double kFar = 20.0;          // of a safe approach: from there on the end tells nothing of what is on the way
constexpr double kBesideSheet = 0.1;   // of a thickness: how far off rows hold what passes a sheet
constexpr double kStandOff = 0.25;     // of the activation distance: how near a piece ends
constexpr double kDepth = 1e-3;      // of the activation distance: overlap that is left to contacts and their push-out
constexpr double kSelfDepth = 1e-6;  // the same of a body with itself, whose contacts keep it apart by more than that
constexpr double kApart = 0.05;      // of the arms of an attachment: farther apart its points don't end
constexpr double kLeastTorn = 1.0 / 32.0;  // of a sub-step: pieces of what comes apart all the same
constexpr double kReach = 0.1;             // of the activation distance: paths are straight to this

/// Of two bodies, metres.
auto activation_by(const ContactSettings& contact) {
  return [&contact](const Body& a, const Body& b) { return contact.activation_distance.at(pair_size(a, b)); };
}

/// Of a pair, metres.
using PairLength = std::function<double(const UnsafeMotion::Pair&)>;

double pair_activation(const Bodies& bodies, const Parameters& parameters, const UnsafeMotion::Pair& p) {
  return activation_by(parameters.contact)(bodies[p.a], bodies[p.b]);
}

/// What counts as a passage, of the activation distance of two bodies; `is_kept`: of motions that are undone. What a sub-step
/// finds in something else by more than that hasn't passed it on the way.
PassagesOf passages_within(const Bodies& bodies, const ContactSettings& contact, const SubStep& step, bool is_kept) {
  return [&, is_kept](BodyIndex a, BodyIndex b) {
    const double size = activation_by(contact)(bodies[a], bodies[b]);
    if (!is_kept) return PassageSettings{size, kReach * size};
    return PassageSettings{a == b ? kSelfDepth * size : kDepth * size + overlap_at_start(bodies, step, {a, b}),
                           kReach * size};
  };
}

/// The share of a motion after which the points of the earliest meeting are kStandOff apart; none: they are no
/// farther from one another to begin with, or the motion is so long that its first moment is all that is known to be safe.
std::optional<double> safe_share(const UnsafeMotion& motion, const PairLength& activation) {
  double safe = 1.0;
  for (const UnsafeMotion::Pair& pair : motion.pairs) {
    const double stand_off = kStandOff * activation(pair);
    for (const Passage& p : pair.passages) {
      const double way = (p.point_a - p.point_b).norm();
      if (way <= 2.0 * stand_off) return std::nullopt;
      safe = std::min(safe, p.time * (1.0 - stand_off / way));
    }
  }
  if (!(safe > kNoShare)) return std::nullopt;
  return safe;
}

/// How far apart features of a pair may begin that get rows before anything is cut. What turns in a hole slides over
/// facets and meets others than it began with: rows of those hold it where turns are followed, as long as the way is one
/// that contacts see well. What turns over a sheet is through it before that shows in its end, and for its contacts nothing
/// there is near: the same rows hold it, as far as they would if the sheet were the side of something thick.
PairLength reach_of_rows(const Bodies& bodies, const SubStep& step, bool turns_are_followed) {
  return [&bodies, &step, turns_are_followed](const UnsafeMotion::Pair& p) {
    const auto deforms = [&](BodyIndex b) { return bodies[b].kind() == BodyKind::deformable; };
    if (!turns_are_followed || deforms(p.a) || deforms(p.b)) return 0.0;
    const double thick = thick_beside_sheet(*bodies[p.a].shape, *bodies[p.b].shape);
    if (thick > 0.0 && p.approach > kFar * p.safe) return kBesideSheet * thick;
    return are_interlocked(step.collisions, {p.a, p.b}) ? p.safe : 0.0;
  };
}

/// Every group has an answer to go on with.
bool is_usable(const SubStep& step) {
  return std::all_of(step.results.begin(), step.results.end(), [](const GroupResult& r) { return r.is_usable; });
}

/// A motion of which nothing was tried yet.
void begin(SubStep& step) {
  step.asked.clear(), step.brought.clear(), step.passing.clear();
  step.tried.reset();
}

/// Contacts of the features that pass, begin no farther from one another than `reach` of their pair says, and have none
/// of this normal yet. False: each had one.
bool ask_for(const UnsafeMotion& motion, const PairLength& reach, std::vector<Collision>& asked) {
  bool is_new = false;
  for (const UnsafeMotion::Pair& pair : motion.pairs) {
    const double farthest = reach(pair);
    for (const Passage& p : pair.passages) {
      if ((p.point_a - p.point_b).norm() > farthest) continue;
      const auto same = std::find_if(asked.begin(), asked.end(), [&](const Collision& c) {
        return c.body_a == pair.a && c.body_b == pair.b && c.feature == p.feature;
      });
      if (same != asked.end()) continue;
      const double gap = p.normal.dot(p.point_a - p.point_b);
      // another place of what has a formula may touch a face, whose normal it is
      const FeaturePair f = features_of_key(p.feature);
      const BodyIndex owner = f.is(Feature::shape, Feature::face)   ? pair.b
                              : f.is(Feature::face, Feature::shape) ? pair.a
                                                                    : BodyIndex();
      asked.push_back(
          {pair.a, pair.b, p.triangle_a, p.triangle_b, p.point_a, p.point_b, p.normal, gap, owner, p.feature});
      is_new = true;
    }
  }
  return is_new;
}

/// Rows before anything is cut: whether the sub-step may have some, and the piece has. And whether a long way was cut.
struct Asking {
  bool may = true, has = false, is_cut = false;
  /// Whether the piece was cut for what deforms: driven into each other, soft surfaces pass in the next one too, which shows
  /// only when all its looks are spent. It grows from this one's length then.
  bool bends = false;
  /// Whether rows bring anything yet: fewer pairs pass than in the motions before. Of many that hang in one another each
  /// that is held has the next pass, and no number of rows is an end of that: a shorter piece is.
  bool brings(std::size_t pairs) {
    idle = pairs < fewest ? 0 : idle + 1;
    fewest = std::min(fewest, pairs);
    return idle < (pairs < kMany ? kPatience : kPatienceWithMany);
  }
  void shorten() { fewest = kNone, idle = 0; }
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::size_t fewest = kNone;  // pairs that passed
  int idle = 0;                // motions since
  bool gave_up = false;        // in the piece
  PieceLengths lengths{kMostPieces, kLeastShare};
  /// Takes them back where a solve with them has no answer: it is cut then.
  bool is_refused(SubStep& step) {
    if (!has || is_usable(step)) return false;
    may = has = false;
    begin(step);
    return true;
  }
  /// What the next piece tries: all that is left, or after a cut of a long way a few times as much, since the next meeting
  /// is as near as a rule, and what a long motion comes upon is dear to find, to solve and to look back at.
  double next_share(double share, int motions) const {
    if (gave_up) return motions > kPatience ? share : kGrowth * share;
    if (bends || (has && motions > kPatience)) return kGrowth * share;
    return is_cut ? kAfterCut * share : 1.0;
  }
};

void begin_piece(SubStep& step, PassiveRebounds& passive, Asking& asking) {
  begin(step);
  step.rebounds.clear(), passive = {}, asking.has = asking.bends = asking.gave_up = false, asking.shorten();
}

/// By the contacts of the poses that bodies have; empty: those would not tell depths.
OverlapsOf overlaps_by(const Bodies& bodies, const Parameters& parameters) {
  if (parameters.contact.points != ContactPoints::proximity) return {};
  return [&](std::vector<BodyPair> pairs) { return overlaps_now(bodies, detecting(parameters), std::move(pairs)); };
}

/// Has second looks see the ends of rigid bodies that pass, where rows of what they overlap with may hold them. False: they
/// saw all of them and brought nothing, or that is far.
bool look_at_ends(const Bodies& bodies, const UnsafeMotion& motion, SubStep& step) {
  bool is_new = false;
  for (const UnsafeMotion::Pair& p : motion.pairs) {
    const BodyPair pair{p.a, p.b};
    const auto is_of_pair = [&](const Collision& c) { return c.body_a == p.a && c.body_b == p.b; };
    const auto at = std::lower_bound(step.passing.begin(), step.passing.end(), pair);
    if (at != step.passing.end() && *at == pair) continue;
    if (bodies[p.a].kind() == BodyKind::deformable || bodies[p.b].kind() == BodyKind::deformable) continue;
    if (p.approach > kFar * p.safe || (step.group_of(p.a).is_none() && step.group_of(p.b).is_none())) continue;
    if (std::binary_search(step.seen_at_end.begin(), step.seen_at_end.end(), pair) &&
        std::none_of(step.brought.begin(), step.brought.end(), is_of_pair))
      continue;
    step.passing.insert(at, pair);
    is_new = true;
  }
  return is_new;
}

/// Whether what passes deforms.
bool of_deforming(const Bodies& bodies, const UnsafeMotion& motion) {
  return std::any_of(motion.pairs.begin(), motion.pairs.end(), [&](const UnsafeMotion::Pair& p) {
    return bodies[p.a].kind() == BodyKind::deformable || bodies[p.b].kind() == BodyKind::deformable;
  });
}

/// What changes for the next motion of a piece: ends are looked at, features that pass get rows, or it is tried with a share
/// of its length.
double ask_or_cut(const Bodies& bodies, const UnsafeMotion& motion, const PairLength& seen,
                  const PairLength& activation, bool may_look, bool is_patient, Asking& asking, SubStep& step) {
  asking.lengths.made_in_vain(step.collisions.size());
  const bool brings = asking.brings(motion.pairs.size());
  if (brings && may_look && is_patient && look_at_ends(bodies, motion, step)) return 1.0;
  asking.bends |= of_deforming(bodies, motion);
  if (asking.may && brings && ask_for(motion, seen, step.asked)) return asking.has = true, 1.0;
  asking.is_cut |= std::any_of(motion.pairs.begin(), motion.pairs.end(),
                               [](const UnsafeMotion::Pair& p) { return p.approach > kLongWay * p.safe; });
  const auto cut = [&](double part) {
    asking.lengths.cut();
    return part;
  };
  const std::optional<double> safe = safe_share(motion, activation);
  if (!brings) {
    asking.gave_up = true, asking.shorten();
    return cut(std::min(safe.value_or(1.0), motion.pairs.size() < kMany ? 0.5 : kMuchShorter));
  }
  if (safe) return cut(is_patient ? *safe : 0.5 * *safe);
  const PairLength any = [](const UnsafeMotion::Pair&) { return INFINITY; };
  return ask_for(motion, any, step.asked) ? 1.0 : cut(0.5);
}

/// Takes out the rows that looks brought of an end which a cut motion doesn't come to. Their key is that of wherever a formula
/// touches, also from where the motion starts; those of two meshes are of features with keys of their own.
void forget_end(const Bodies& bodies, SubStep& step) {
  const auto has_formula = [&](BodyIndex b) { return bodies[b].shape->mesh() == nullptr; };
  std::erase_if(step.brought, [&](const Collision& c) { return has_formula(c.body_a) || has_formula(c.body_b); });
}

/// The largest even part of what is left of a sub-step that is no larger than `most`: the drift of an attachment is taken
/// back within the next piece, and faster in a shorter one.
double even_part(double rest, double most) { return rest / std::ceil(rest / most * (1.0 - 1e-12)); }

/// Cuts of a sub-step between impacts.
struct ImpactCuts {
  int count = 0;
  bool wants_more = false;  ///< than it may have
};

/// The share with which a motion is made anew, so that it ends at its first impact, or that its rebounds win no energy;
/// none: it may stand.
std::optional<double> share_for_impacts(const Bodies& bodies, SubStep& step, const Parameters& parameters,
                                        ImpactCuts& cuts, PassiveRebounds& passive, StepWatcher* watcher) {
  const ContactSettings& contact = parameters.contact;
  const double gravity = scale_gravity(parameters.simulation.gravity);
  const bool may_cut = cuts.count < contact.successive_impacts;
  if (may_cut || (cuts.count > 0 && !cuts.wants_more))
    if (const auto before = share_to_first_impact(bodies, step, contact, gravity)) {
      cuts.wants_more = !may_cut;
      if (may_cut) {
        ++cuts.count;
        if (watcher != nullptr) watcher->struck(bodies, step, *before);
        return *before;
      }
    }
  if (!passive.weaken(bodies, step, contact, !may_cut && cuts.count > 0)) return std::nullopt;
  return 1.0;
}

/// Adds the bodies of pairs that pass to those that stay, and takes out the pairs of which one is new there. A body that
/// passes through itself is not held: it would hang in the air. Nor is what is driven.
UnsafeMotion take_stoppable(const Bodies& bodies, UnsafeMotion& motion, std::set<BodyIndex>& stay) {
  UnsafeMotion taken;
  std::erase_if(motion.pairs, [&](UnsafeMotion::Pair& pair) {
    bool is_new = false;
    for (const BodyIndex b : {pair.a, pair.b})
      if (pair.a != pair.b && bodies[b].has_freedom() && !bodies[b].asleep) is_new |= stay.insert(b).second;
    if (is_new) taken.pairs.push_back(std::move(pair));
    return is_new;
  });
  return taken;
}

/// Bodies stay that pass others; they may be in the way of others yet, which stay then too. `hold`: of those that are new,
/// takes what still passes into `unsafe`.
template <class Hold>
void hold_those_that_pass(const Bodies& bodies, std::optional<UnsafeMotion>& unsafe, std::set<BodyIndex>& stay,
                          Hold&& hold) {
  while (unsafe) {
    const UnsafeMotion held = take_stoppable(bodies, *unsafe, stay);
    if (held.pairs.empty()) return;
    hold(held);
  }
}

UnsafeBody::Cause why_let_go(Continuous which, bool is_kept) {
  if (is_kept) return UnsafeBody::cut_limit;
  return which == Continuous::off ? UnsafeBody::unwatched : UnsafeBody::soft_contact;
}

/// Nobody stays where motions are not undone, and no start is known.
void let_stay(const std::optional<PieceStart>& start, Bodies& bodies, const std::set<BodyIndex>& which,
              MotionGuard& guard) {
  for (const BodyIndex b : which) start->let_stay(bodies[b], b), guard.stayed(b);
}

}  // namespace

void World::note_unsafe(const UnsafeMotion& motion, int substep, UnsafeBody::Cause cause) {
  for (const UnsafeMotion::Pair& pair : motion.pairs)
    for (const bool is_a : {true, false}) {
      const BodyIndex body = is_a ? pair.a : pair.b, other = is_a ? pair.b : pair.a;
      // what lives on overlap is let in by a little, and nobody asked how far it came
      const bool has_passed =
          !pair.passages.empty() && cause != UnsafeBody::soft_contact && cause != UnsafeBody::held_back;
      const UnsafeBody now{bodies_[body].name, bodies_[other].name, cause,     substep, is_a ? pair.way_a : pair.way_b,
                           pair.approach,      pair.safe,           has_passed};
      UnsafeBody& known = unsafe_.try_emplace(body, now).first->second;
      if (has_passed && !known.has_passed) known = now;
    }
}

void World::substep(double h, int left, FrozenStep* frozen) {
  const Continuous which = watching(parameters);
  const int substep = parameters.simulation.substeps - left + 1;
  // what lives on overlap is only watched: no contact at a distance would hold it
  const bool is_kept = which != Continuous::off && !parameters.response.method->lives_on_overlap();
  const bool is_rough = is_kept && parameters.response.method->is_approximate();
  const PassagesOf passages = passages_within(bodies_, parameters.contact, *sub_step_, is_kept);
  const OverlapsOf overlaps = is_kept && !is_rough ? overlaps_by(bodies_, parameters) : OverlapsOf();
  const PairLength of_pair = [&](const UnsafeMotion::Pair& p) { return pair_activation(bodies_, parameters, p); };
  const PairLength seen = reach_of_rows(bodies_, *sub_step_, parameters.contact.turning_solves > 0);
  if (bodies_.all_active()) has_rebounds_ = has_rebounds(bodies_, parameters.contact);
  const bool rebounds = !parameters.response.method->is_approximate() && has_rebounds_;
  ImpactCuts cuts;
  PassiveRebounds passive;
  double rest = 1.0, next = 1.0;  // of the sub-step: what is left, and what the next piece tries
  Asking asking;
  std::set<BodyIndex> stay;  // for the rest of it
  EarlierPieces earlier(*sub_step_);
  for (int piece = 1; rest > 0.0; ++piece) {
    std::optional<PieceStart> start;
    {
      const StageTimer timer(stats_.times.guard_ms);
      if (is_kept || rebounds) start.emplace(bodies_, sleeping_, [this](BodyIndex b) { return state_.of(b); });
      guard_.open(bodies_);
    }
    begin_piece(*sub_step_, passive, asking);
    double share = std::min(next, even_part(rest, share_of_turns(attachments_, bodies_, h)));
    if (piece == 1) sub_step_->drift_time = share * h;  // as if the sub-step before had been cut alike
    const double apart = most_apart(attachments_, bodies_);
    int motion = 1;
    for (;; ++motion) {
      make_motion(share == 1.0 ? h : share * h, share / (left - 1 + rest), frozen != nullptr && share == rest);
      if (asking.is_refused(*sub_step_)) {
        start->bring_back(bodies_, sleeping_);
        continue;
      }
      if (rebounds && motion < kMostMotions)
        if (const auto before = share_for_impacts(bodies_, *sub_step_, parameters, cuts, passive, watcher_)) {
          share *= *before;
          start->take_back(*sub_step_, bodies_, sleeping_);
          continue;
        }
      const auto look_back = [&] {
        const StageTimer timer(stats_.times.guard_ms);
        let_stay(start, bodies_, stay, guard_);
        return guard_.look(bodies_, which, passages, is_rough, piece > 1, overlaps);
      };
      std::optional<UnsafeMotion> unsafe = look_back();
      const bool is_last = !is_kept || piece >= kMostPieces || motion >= kMostMotions || share < kLeastShare,
                 tears = !unsafe && !is_last && share > kLeastTorn &&
                         most_apart(attachments_, bodies_) > std::max(kApart, apart),
                 is_end = is_last || !(unsafe || tears);
      if (watcher_ != nullptr) watcher_->moved(bodies_, *sub_step_, guard_, unsafe, is_end);
      if (!unsafe && !tears) break;
      if (is_end) {
        if (which == Continuous::off && watcher_ != nullptr && watcher_->wants_passages())
          guard_.find_passages(bodies_, *unsafe, passages);
        if (is_kept)
          hold_those_that_pass(bodies_, unsafe, stay, [&](const UnsafeMotion& held) {
            note_unsafe(held, substep, UnsafeBody::held_back);
            unsafe = look_back();
          });
        if (unsafe) note_unsafe(*unsafe, substep, why_let_go(which, is_kept));
        break;
      }
      const double part = tears ? 0.5
                                : ask_or_cut(bodies_, *unsafe, seen, of_pair, may_look_again(), motion <= kPatience,
                                             asking, *sub_step_);
      if (part < 1.0) share *= part, forget_end(bodies_, *sub_step_);
      start->take_back(*sub_step_, bodies_, sleeping_);
    }
    rest = share == rest ? 0.0 : rest - share;
    next = asking.lengths.next(asking.next_share(share, motion), rest);
    sub_step_->drift_time = sub_step_->time_step;
    take_results(rest == 0.0 ? frozen : nullptr);
    earlier.close(bodies_, rest == 0.0);
  }
  stats_.merged_impacts += cuts.wants_more ? 1 : 0;
  tell_finished(substep);
}

void World::tell_finished(int substep) {
  if (ledger_) ledger_->close_substep(substep);
  if (watcher_ == nullptr) return;
  watcher_->finished(bodies_, substep);
  if (!watcher_->wants_record(substep, parameters.simulation.substeps)) return;
  FrameStats so_far = stats_;
  if (ledger_) so_far.ledger = ledger_->so_far(bodies_);
  StepRecord record;
  describe(solved_contacts(), so_far, record);
  watcher_->recorded(bodies_, record, substep, parameters.simulation.substeps);
}

}  // namespace impinge
