#include "engine/step/second_look.hpp"

#include <algorithm>

#include "engine/contact/contact_reduction.hpp"
#include "engine/contact/fewest_carriers.hpp"
#include "engine/contact/pair_scale.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/step/end_pose.hpp"
#include "engine/step/find_collisions.hpp"
#include "engine/step/find_pairs.hpp"
#include "engine/step/remember.hpp"

namespace impinge {
namespace {

constexpr double kTolerance = 1e-2;  // of the activation distance: overlap that recovery takes for little
constexpr int kMostBack = 8;         // of the dropped contacts of a pair that come back at once
constexpr double kNearly = 1e-4;     // relative residual: what is answered to this is worth more than an overlap
constexpr double kFarWorse = 10.0;   // than what a solve left: what goes in by as much more can't be overlooked

bool is_rigid(const Body& body) { return body.kind() != BodyKind::deformable; }
bool is_of(const Collision& c, const BodyPair& pair) { return c.body_a == pair.a && c.body_b == pair.b; }
Twist twist_of(const Collider& c) { return {c.velocity, c.angular_velocity}; }

void merge_triangles(const std::vector<TrianglePair>& found, std::vector<TrianglePair>& all) {
  const auto middle = all.insert(all.end(), found.begin(), found.end());
  std::inplace_merge(all.begin(), middle, all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

void merge_pairs(const std::vector<BodyPair>& found, std::vector<BodyPair>& all) {
  for (const BodyPair& pair : found) {
    const auto at = std::lower_bound(all.begin(), all.end(), pair);
    if (at != all.end() && *at == pair)
      at->margin = std::max(at->margin, pair.margin);
    else
      all.insert(at, pair);
  }
}

/// In pair order, after those of the same pair.
void insert(std::vector<Collision> more, std::vector<Collision>& all) {
  const auto before = [](const Collision& l, const Collision& r) {
    return std::pair(l.body_a, l.body_b) < std::pair(r.body_a, r.body_b);
  };
  const auto middle = all.insert(all.end(), more.begin(), more.end());
  std::stable_sort(middle, all.end(), before);
  std::inplace_merge(all.begin(), middle, all.end(), before);
}

int iterations_of(const std::vector<GroupResult>& results) {
  int sum = 0;
  for (const GroupResult& r : results) sum += r.iterations;
  return sum;
}

}  // namespace

SecondLook::SecondLook(const Bodies& bodies, const Detecting& by, SubStep& step)
    : bodies_(bodies), by_(by), step_(step), colliders_(step.later) {}

std::span<const Collider> SecondLook::take_velocities() {
  step_.begin_later(bodies_);
  for (std::size_t g = 0; g < step_.groups.size(); ++g)
    for (std::size_t i = 0; i < step_.groups[g].bodies.size(); ++i) {
      const BodyIndex b = step_.groups[g].bodies[i];
      if (!is_rigid(bodies_[b])) continue;
      colliders_[b].velocity += step_.results[g].velocity[i].twist.linear;
      colliders_[b].angular_velocity += step_.results[g].velocity[i].twist.angular;
    }
  return colliders_;
}

bool SecondLook::find(StageTimes& times) {
  check_interrupt();
  back_.clear(), pairs_.clear(), triangles_.clear(), found_.clear();
  find_dropped();
  if (is_anyone_driven()) find_driven(times);
  {
    const StageTimer timer(times.narrow_ms);
    step_.seen_at_end = pairs_at_end(bodies_, by_.contact, step_, colliders_);
    ahead_ = overlaps_at_end(bodies_, by_, step_, colliders_, step_.seen_at_end);
  }
  std::erase_if(ahead_, [&](const Collision& c) {  // a row that is there needs to be told of turning, and not again
    return std::any_of(step_.collisions.begin(), step_.collisions.end(), [&](const Collision& k) {
      return key_of(k) == key_of(c) && k.normal == c.normal && k.gap == c.gap;
    });
  });
  return !back_.empty() || !found_.empty() || !ahead_.empty();
}

double SecondLook::missed_speed() const {
  double fastest = 0.0;
  for (const std::vector<Collision>* list : {&back_, &found_, &ahead_})
    for (const Collision& c : *list) {
      const double beyond = -end_gap(c) - by_.contact.activation(pair_size(bodies_[c.body_a], bodies_[c.body_b]));
      fastest = std::max(fastest, beyond / step_.time_step);
    }
  return fastest;
}

void SecondLook::find_dropped() {
  const std::vector<Collision>& dropped = step_.dropped;
  for (std::size_t first = 0, last = 0; first < dropped.size(); first = last) {
    const BodyPair pair{dropped[first].body_a, dropped[first].body_b};
    std::vector<std::pair<double, std::size_t>> worst;
    for (last = first; last < dropped.size() && is_of(dropped[last], pair); ++last)
      if (is_awake_and_rigid(pair.a, pair.b) && ends_as_overlap(dropped[last]))
        worst.emplace_back(end_gap(dropped[last]), last);
    std::sort(worst.begin(), worst.end());
    worst.resize(std::min<std::size_t>(worst.size(), kMostBack));
    for (const auto& [gap, i] : worst) back_.push_back(dropped[i]);
  }
}

/// Whether any two bodies could have been driven together by more than contacts see.
bool SecondLook::is_anyone_driven() const {
  double first = 0.0, second = 0.0, least = INFINITY;
  const auto counts = [](const Body& body) { return is_rigid(body) && !body.asleep && body.has_freedom(); };
  for (std::size_t g = 0; g < step_.groups.size(); ++g)
    for (std::size_t i = 0; i < step_.groups[g].bodies.size(); ++i) {
      const Body& body = bodies_[step_.groups[g].bodies[i]];
      const Twist& change = step_.results[g].velocity[i].twist;
      if (!counts(body)) continue;
      const double way = step_.time_step * (change.linear.norm() + change.angular.norm() * body.radius);
      second = std::max(second, std::min(first, way));
      first = std::max(first, way);
    }
  for (const BodyIndex b : bodies_.active())
    if (counts(bodies_[b])) least = std::min(least, by_.contact.activation(bodies_[b].size));
  return first + second > least;
}

std::vector<BodyPair> SecondLook::driven_pairs() const {
  SearchBoxes boxes = step_.boxes;
  boxes.update(bodies_, colliders_, by_.contact, step_.time_step);
  std::vector<BoxPair> box_pairs;
  find_moving_pairs(bodies_, boxes.by_body, by_.broad_phase, box_pairs);
  std::vector<BodyPair> pairs;
  for (const auto& [first, second] : box_pairs) {
    const BodyIndex a(first), b(second);
    if (is_driven(a, b))
      pairs.push_back({a, b, search_margin(bodies_, colliders_, a, b, by_.contact, step_.time_step)});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void SecondLook::find_driven(StageTimes& times) {
  {
    const StageTimer timer(times.broad_ms);
    pairs_ = driven_pairs();
  }
  if (pairs_.empty()) return;
  for (const BodyPair& pair : pairs_)
    sought_[{pair.a, pair.b}] = {twist_of(colliders_[pair.a]), twist_of(colliders_[pair.b])};
  const StageTimer timer(times.narrow_ms);
  find_collisions(colliders_, pairs_, by_, step_.time_step, triangles_, found_);
  std::vector<ContactKey> known;
  for (const std::vector<Collision>* list : {&step_.collisions, &step_.dropped})
    for (const Collision& c : *list) known.push_back(key_of(c));
  std::sort(known.begin(), known.end());
  std::erase_if(found_, [&](const Collision& c) { return std::binary_search(known.begin(), known.end(), key_of(c)); });
  const auto is_missed = [&](const BodyPair& pair) {
    return std::any_of(found_.begin(), found_.end(),
                       [&](const Collision& c) { return is_of(c, pair) && ends_as_overlap(c); });
  };
  std::erase_if(pairs_, [&](const BodyPair& pair) { return !is_missed(pair); });
  const auto is_left = [&](BodyIndex a, BodyIndex b) {
    return std::binary_search(pairs_.begin(), pairs_.end(), BodyPair{a, b});
  };
  std::erase_if(found_, [&](const Collision& c) { return !is_left(c.body_a, c.body_b); });
  std::erase_if(triangles_, [&](const TrianglePair& t) { return !is_left(t.a, t.b); });
}

void SecondLook::add(const ContactCache& carried) {
  merge_pairs(pairs_, step_.pairs);
  merge_triangles(triangles_, step_.triangle_pairs);
  for (const BodyPair& pair : pairs_) {
    std::vector<Collision> of_pair;
    for (const std::vector<Collision>* list : {&step_.collisions, &found_})
      std::copy_if(list->begin(), list->end(), std::back_inserter(of_pair),
                   [&](const Collision& c) { return is_of(c, pair); });
    std::erase_if(step_.collisions, [&](const Collision& c) { return is_of(c, pair); });
    if (by_.contact.reduction != Reduction::none)
      insert(reduce_contacts(bodies_, carried, step_.colliders, step_.asked, by_.contact, of_pair), step_.dropped);
    insert(std::move(of_pair), step_.collisions);
  }
  std::erase_if(step_.dropped, [&](const Collision& c) {
    return std::any_of(back_.begin(), back_.end(), [&](const Collision& b) { return key_of(b) == key_of(c); });
  });
  insert(back_, step_.collisions);
  for (const Collision& c : ahead_) {  // where it ends counts more than where it began
    const auto same = std::find_if(step_.collisions.begin(), step_.collisions.end(),
                                   [&](const Collision& k) { return key_of(k) == key_of(c); });
    if (same != step_.collisions.end())
      *same = c;
    else
      insert({c}, step_.collisions);
  }
  end_flights(bodies_, step_);
  for (const std::vector<Collision>* list : {&back_, &found_, &ahead_})
    step_.brought.insert(step_.brought.end(), list->begin(), list->end());
  exchange();
}

/// What came back takes the places of those that turned out not to carry: these wait in their turn. Where too many carry,
/// those that others can carry for hand on what they have.
void SecondLook::exchange() {
  const std::vector<Collision>& now = step_.collisions;
  const auto most = static_cast<std::size_t>(by_.contact.most_contacts);
  std::vector<std::span<const Collision>> crowded;  // by pair
  for (std::size_t first = 0, last = 0; first < now.size(); first = last) {
    const BodyPair pair{now[first].body_a, now[first].body_b};
    while (last < now.size() && is_of(now[last], pair)) ++last;
    if (last - first > most && is_awake_and_rigid(pair.a, pair.b)) crowded.emplace_back(&now[first], last - first);
  }
  if (crowded.empty()) return;
  std::map<ContactKey, Vec3*> impulses;
  for (GroupResult& r : step_.results)
    for (ContactCache::Item& item : r.impulses) impulses[item.key] = &item.impulse;
  std::vector<ContactKey> waiting;
  for (const std::span<const Collision> of_pair : crowded) hand_on(of_pair, of_pair.size() - most, impulses, waiting);
  if (waiting.empty()) return;
  std::sort(waiting.begin(), waiting.end());
  const auto waits = [&](const Collision& c) { return std::binary_search(waiting.begin(), waiting.end(), key_of(c)); };
  std::vector<Collision> more;
  std::copy_if(now.begin(), now.end(), std::back_inserter(more), waits);
  std::erase_if(step_.collisions, waits);
  insert(std::move(more), step_.dropped);
}

/// Adds `count` contacts of a pair to those that wait, or as many as can.
void SecondLook::hand_on(std::span<const Collision> of_pair, std::size_t count,
                         const std::map<ContactKey, Vec3*>& impulses, std::vector<ContactKey>& waiting) const {
  std::vector<std::pair<double, ContactKey>> idle;
  std::vector<CarriedImpulse> carried;
  std::vector<ContactKey> carriers;
  for (const Collision& c : of_pair) {
    const auto known = impulses.find(key_of(c));
    if (known == impulses.end() || ends_as_overlap(c)) continue;
    if (known->second->isZero(0.0))
      idle.emplace_back(-end_gap(c), known->first);
    else
      carried.push_back({c.common_point(), *known->second}), carriers.push_back(known->first);
  }
  std::sort(idle.begin(), idle.end());
  idle.resize(std::min(idle.size(), count));
  for (const auto& [gap, key] : idle) waiting.push_back(key);
  const std::size_t left = count - idle.size();
  if (left == 0 || carried.size() <= left) return;
  const std::vector<double> shares = fewer_carriers(carried, carried.size() - left);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    *impulses.at(carriers[i]) *= shares[i];
    if (shares[i] == 0.0) waiting.push_back(carriers[i]);
  }
}

bool SecondLook::is_awake_and_rigid(BodyIndex a, BodyIndex b) const {
  return is_rigid(bodies_[a]) && is_rigid(bodies_[b]) && !bodies_[a].asleep && !bodies_[b].asleep;
}

/// Two whose free motion is theirs still, or who hardly approach, have all their contacts. What two that meet in flight come
/// upon after that is for a cut of the sub-step: rows from its start know nothing of it.
bool SecondLook::is_driven(BodyIndex a, BodyIndex b) const {
  const Body &of_a = bodies_[a], &of_b = bodies_[b];
  if (!is_awake_and_rigid(a, b) || !may_respond(bodies_, a, b) || step_.is_flight(a, b)) return false;
  const double activation = by_.contact.activation(pair_size(of_a, of_b));
  if (!(approach(colliders_[a], of_a.radius, colliders_[b], of_b.radius, step_.time_step) > activation)) return false;
  const auto sought = sought_.find({a, b});
  const Twists before =
      sought != sought_.end() ? sought->second : Twists{twist_of(step_.colliders[a]), twist_of(step_.colliders[b])};
  const auto changed = [&](BodyIndex i, const Twist& since) {
    Collider c = colliders_[i];
    c.velocity -= since.linear, c.angular_velocity -= since.angular;
    return c;
  };
  return approach(changed(a, before.first), of_a.radius, changed(b, before.second), of_b.radius, step_.time_step) >
         activation;
}

/// As the contact's row says, or the row would not mend what is missed here.
double SecondLook::end_gap(const Collision& c) const {
  const Vec3 closing =
      colliders_[c.body_a].velocity_at(c.acts_on_a()) - colliders_[c.body_b].velocity_at(c.acts_on_b());
  return c.gap + step_.time_step * c.normal.dot(closing);
}

bool SecondLook::ends_as_overlap(const Collision& c) const {
  const double allowed = kTolerance * by_.contact.activation(pair_size(bodies_[c.body_a], bodies_[c.body_b]));
  return end_gap(c) < std::min(c.gap, 0.0) - allowed;
}

SolvedBefore::SolvedBefore(const SubStep& step, const ContactList& contacts)
    : collisions_(step.collisions),
      dropped_(step.dropped),
      start_(step.start),
      groups_(step.groups),
      results_(step.results),
      brought_(step.brought.size()) {
  for (const CollisionGroup& group : step.groups) {
    keys_.emplace_back();
    for (const ContactIndex c : group.contacts) keys_.back().push_back(contacts.key(c));
  }
}

int SolvedBefore::solve_changed(Bodies& bodies, std::span<const Attachment> attachments, const Solving& how,
                                SubStep& step, StageTimes& times) const {
  const ContactList contacts = step.contacts(attachments);
  step.start = remembered_impulses(impulses_of(step.results), contacts);
  step.groups = find_groups(bodies, contacts);

  std::map<BodyIndex, std::size_t> with_first;  // the old groups by their lowest body
  for (std::size_t g = 0; g < groups_.size(); ++g) with_first[groups_[g].bodies.front()] = g;
  std::vector<char> is_same(step.groups.size(), 0);
  step.results.clear();
  step.results.resize(step.groups.size());
  for (std::size_t g = 0; g < step.groups.size(); ++g) {
    const CollisionGroup& group = step.groups[g];
    const auto old = with_first.find(group.bodies.front());
    if (old == with_first.end() || groups_[old->second].bodies != group.bodies) continue;
    const std::vector<ContactKey>& keys = keys_[old->second];
    const auto has_key = [&](ContactIndex c, const ContactKey& key) { return contacts.key(c) == key; };
    if (!std::equal(group.contacts.begin(), group.contacts.end(), keys.begin(), keys.end(), has_key)) continue;
    const std::vector<ContactIndex>& places = groups_[old->second].contacts;
    const auto is_where_it_was = [&](ContactIndex c, ContactIndex before) {
      const Collision *now = contacts.collision(c), *then = ContactList{collisions_, attachments}.collision(before);
      return now == nullptr || (now->normal == then->normal && now->gap == then->gap);
    };
    if (!std::equal(group.contacts.begin(), group.contacts.end(), places.begin(), places.end(), is_where_it_was))
      continue;
    GroupResult& result = step.results[g] = results_[old->second];
    is_same[g] = result.is_provisional && !how.is_provisional ? 0 : 1;
    if (is_same[g] == 0) continue;
    for (ContactIndex& c : result.contacts)
      c = group.contacts[static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), c) - places.begin())];
    for (SolvedContact& c : result.solved) c.group = GroupIndex(g);
  }
  respond(bodies, contacts, step.start, step.groups, is_same, how, step.results, times);
  int iterations = iterations_of(results_);
  for (std::size_t g = 0; g < step.results.size(); ++g)
    if (is_same[g] != 0) iterations -= step.results[g].iterations;
  return iterations;
}

bool SolvedBefore::was_better(const SubStep& step, double missed_speed) const {
  double left = 0.0;
  for (const GroupResult& r : step.results)
    if (!r.is_answered()) left = std::max(left, r.verdict.residual());
  if (missed_speed > kFarWorse * left) return false;
  const auto unanswered = [](const std::vector<GroupResult>& results) {
    return std::count_if(results.begin(), results.end(), [](const GroupResult& r) {
      return !r.is_answered() && (r.is_contradiction || !(r.verdict.relative <= kNearly));
    });
  };
  return unanswered(step.results) > unanswered(results_);
}

int SolvedBefore::restore(SubStep& step) const {
  const int given_up = iterations_of(step.results);
  step.collisions = collisions_, step.dropped = dropped_;
  step.start = start_;
  step.groups = groups_;
  step.results = results_;
  step.brought.resize(brought_);
  return given_up - iterations_of(results_);
}

}  // namespace impinge
