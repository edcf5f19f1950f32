#include "engine/world/pair_verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/contact/pair_scale.hpp"
#include "engine/detection/pairs/contact_sink.hpp"
#include "engine/detection/pairs/flight.hpp"
#include "engine/step/find_pairs.hpp"
#include "engine/world/world.hpp"

namespace impinge {
namespace {

using enum FilterVerdict::Outcome;
using Numbers = std::vector<NamedNumber>;

constexpr const char* kBrought = "; their contact was brought by a look at where velocities lead";

std::string metres(double x) { return fmt::format("{:.4g} m", x); }
std::string several(std::size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

std::string feature_words(const NearestFeatures& nearest, bool of_a, const std::string& body) {
  const Feature kind = of_a ? nearest.kind_a : nearest.kind_b;
  const int index = of_a ? nearest.index_a : nearest.index_b;
  switch (kind) {
    case Feature::vertex:
      return fmt::format("vertex {} of '{}'", index, body);
    case Feature::edge:
      return fmt::format("edge {} of '{}'", index, body);
    case Feature::face:
      return fmt::format("face {} of '{}'", index, body);
    case Feature::shape:
      break;
  }
  return fmt::format("the surface of '{}'", body);
}

class Report {
 public:
  Report(const World& world, const SubStep& step, BodyIndex a, BodyIndex b, NearestSearch& search)
      : world_(world),
        step_(step),
        a_(world.bodies()[a]),
        b_(world.bodies()[b]),
        of_a_(step.colliders[a]),
        of_b_(step.colliders[b]),
        is_self_(a == b) {
    const Parameters& p = world.parameters;
    v_.frame = world.frame(), v_.substeps = p.simulation.substeps;
    v_.time = step.time, v_.time_step = step.time_step;
    v_.a = a, v_.b = b;
    v_.name_a = a_.name, v_.name_b = b_.name;
    v_.shape_a = a_.shape->name(), v_.shape_b = b_.shape->name();
    v_.kind_a = a_.kind(), v_.kind_b = b_.kind();
    v_.box_a = of_a_.bounds, v_.box_b = of_b_.bounds;
    v_.swept_a = step.boxes.by_body[a], v_.swept_b = step.boxes.by_body[b];
    for (const Collision& c : step.collisions)
      if (c.body_a == a && c.body_b == b) v_.contacts.push_back(c);
    if (!a_.deleted && !b_.deleted) v_.nearest = search.find(step.colliders, a, b, INFINITY);
    if (is_self_ && v_.in_contact()) v_.nearest = features_of(deepest());
  }

  PairVerdict take() {
    kind();
    asleep();
    exempt();
    boxes();
    broad_phase();
    candidates();
    distance();
    contacts();
    reduction();
    return std::move(v_);
  }

 private:
  /// What stops the pair stops it for all that follow.
  void add(std::string_view filter, bool passes_it, std::string words, Numbers numbers = {}) {
    const FilterVerdict::Outcome outcome = is_stopped_ ? not_asked : passes_it ? passes : stops;
    is_stopped_ = is_stopped_ || !passes_it;
    v_.filters.push_back({filter, outcome, std::move(words), std::move(numbers)});
  }
  void add_idle(std::string_view filter, std::string words, Numbers numbers = {}) {
    v_.filters.push_back({filter, not_asked, std::move(words), std::move(numbers)});
  }

  const Collision& deepest() const {
    return *std::min_element(v_.contacts.begin(), v_.contacts.end(),
                             [](const Collision& l, const Collision& r) { return l.gap < r.gap; });
  }

  std::string kinds(const Body& body) const { return fmt::format("'{}' is {}", body.name, kind_name(body.kind())); }

  void kind() {
    for (const Body* body : {&a_, &b_})
      if (body->deleted)
        return add("kind", false, fmt::format("'{}' is {}", body->name, body->absent ? "not there yet" : "deleted"));
    if (is_self_) {
      const bool is_soft = a_.kind() == BodyKind::deformable;
      return add("kind", is_soft, kinds(a_) + (is_soft ? "" : ": what doesn't deform can't meet itself"));
    }
    const bool moves = a_.has_freedom() || b_.has_freedom();
    add("kind", moves, fmt::format("{}, {}{}", kinds(a_), kinds(b_), moves ? "" : ": a contact would move neither"));
  }

  std::string rest_of(const Body& body) const {
    if (!body.asleep) return fmt::format("'{}' {}", body.name, body.is_moving() ? "is awake" : "stands still");
    return fmt::format("'{}' sleeps, with '{}'", body.name,
                       body.island.is_none() ? body.name : world_.bodies()[body.island].name);
  }

  void asleep() {
    Numbers numbers = {{"rest_time_a_s", a_.rest_time}, {"rest_time_b_s", b_.rest_time}};
    if (is_self_) return add("asleep", !a_.asleep, rest_of(a_), {numbers.front()});
    const bool moves = a_.is_moving() || b_.is_moving();
    add("asleep", moves,
        fmt::format("{}, {}{}", rest_of(a_), rest_of(b_), moves ? "" : ": nothing has changed between them"),
        std::move(numbers));
  }

  void exempt() {
    if (is_self_)
      return add("exempt", a_.self_collision,
                 fmt::format("self_collision of '{}' is {}", a_.name, a_.self_collision ? "on" : "off"));
    std::vector<std::string> joints;
    for (const AttachmentRecord& t : world_.record().attachments)
      if ((t.body_a == v_.a && t.body_b == v_.b) || (t.body_a == v_.b && t.body_b == v_.a))
        joints.push_back(fmt::format("'{}'", t.name));
    const bool may_touch = !world_.bodies().never_touch(v_.a, v_.b);
    add("exempt", may_touch,
        joints.empty() ? "nothing exempts the pair"
                       : fmt::format("joined by {}, which exempts {}", fmt::join(joints, ", "),
                                     may_touch ? "nothing" : "the pair: collide = false"));
  }

  void boxes() {
    const double gap = box_gap(v_.swept_a, v_.swept_b), still = box_gap(v_.box_a, v_.box_b);
    Numbers numbers = {{"gap_m", gap}, {"gap_at_rest_m", still}, {"limit_m", 0.0}};
    if (is_self_) return add("boxes", true, "one body, one box");
    const bool meet = overlap(v_.swept_a, v_.swept_b);
    std::string words = "the swept boxes overlap";
    if (!meet) {
      const Vec3 apart = (v_.swept_a.min - v_.swept_b.max).cwiseMax(v_.swept_b.min - v_.swept_a.max);
      int axis = 0;
      const double along = apart.maxCoeff(&axis);
      words = fmt::format("the swept boxes are {} apart along {}", metres(along), "xyz"[axis]);
    }
    words += "; each counts in half of an activation distance";
    if (!meet && v_.in_contact()) words += kBrought;
    add("boxes", meet || v_.in_contact(), std::move(words), std::move(numbers));
  }

  double activation() const { return activation_between(world_.parameters, a_, b_); }

  void broad_phase() {
    if (is_stopped_) return add_idle("broad_phase", "");
    const auto it = std::find(step_.pairs.begin(), step_.pairs.end(), BodyPair{v_.a, v_.b});
    is_listed_ = it != step_.pairs.end();
    margin_ = is_listed_ ? it->margin : 0.0;
    Numbers numbers = {{"pairs", static_cast<double>(step_.pairs.size())}};
    if (is_listed_) numbers.push_back({"margin_m", margin_});
    if (is_self_ && is_listed_)
      return add("broad_phase", true,
                 fmt::format("not needed: triangles are looked at up to {} apart", metres(margin_)),
                 std::move(numbers));
    const std::string_view method = world_.parameters.broad_phase.method.name();
    std::string words =
        is_listed_ ? fmt::format("{} hands the pair on, to be looked at up to {} apart", method, metres(margin_))
                   : fmt::format("{} does not hand the pair on", method);
    if (!is_listed_ && v_.in_contact()) words += kBrought;
    add("broad_phase", is_listed_ || v_.in_contact(), std::move(words), std::move(numbers));
  }

  void candidates() {
    if (is_stopped_) return add_idle("candidates", "");
    if (of_a_.shape->mesh() == nullptr || of_b_.shape->mesh() == nullptr) {
      const std::string words =
          fmt::format("{} against {}: the shapes are looked at, not triangles", v_.shape_a, v_.shape_b);
      return add("candidates", true, words);
    }
    std::size_t count = 0, crossing = 0;
    for (const TrianglePair& t : step_.triangle_pairs)
      if (t.a == v_.a && t.b == v_.b) ++count, crossing += t.intersecting ? 1 : 0;
    const bool is_inside = count == 0 && v_.in_contact() && is_listed_;
    add("candidates", count > 0 || v_.in_contact(),
        fmt::format("{} finds {} up to {} apart, {} of them crossing{}", world_.parameters.narrow_phase.method.name(),
                    several(count, "triangle pair"), metres(margin_), crossing,
                    is_inside ? ": one body lies inside the other" : ""),
        {{"triangle_pairs", static_cast<double>(count)},
         {"crossing", static_cast<double>(crossing)},
         {"margin_m", margin_}});
  }

  void distance() {
    if (a_.deleted || b_.deleted) return add_idle("distance", "");
    if (!v_.nearest) return add_idle("distance", is_self_ ? "measured at contacts only" : "two planes have none");
    const NearestFeatures& n = *v_.nearest;
    const Vec3 relative =
        material_velocity(of_a_, n.point_a, n.triangle_a) - material_velocity(of_b_, n.point_b, n.triangle_b);
    const double approach = -step_.time_step * n.normal.dot(relative);
    const bool is_near = n.distance <= activation(), meets = approach > n.distance;
    std::string words =
        fmt::format("{} and {} {}", feature_words(n, true, v_.name_a), feature_words(n, false, v_.name_b),
                    n.distance < 0.0 ? "overlap by " + metres(-n.distance) : "are " + metres(n.distance) + " apart");
    words += fmt::format(": {} the activation distance, {}", is_near ? "within" : "more than", metres(activation()));
    if (!is_near)
      words += approach > 0.0
                   ? fmt::format("{} {} in the sub-step",
                                 meets ? ", but they approach by" : ", and they approach only by", metres(approach))
                   : ", and they don't approach";
    Numbers numbers = {{"distance_m", n.distance}, {"activation_distance_m", activation()},
                       {"approach_m", approach},   {"normal_x", n.normal.x()},
                       {"normal_y", n.normal.y()}, {"normal_z", n.normal.z()}};
    add("distance", is_near || meets || v_.in_contact(), std::move(words), std::move(numbers));
  }

  bool fly_past() const {
    const Detecting by = detecting(world_.parameters);
    const ContactQuery query{by.contact.points == ContactPoints::proximity, activation(), step_.time_step,
                             by.either_may_stop};
    return by.looks_ahead && fly_together(of_a_, of_b_, query, {}) && !time_of_meeting(of_a_, of_b_, query);
  }

  void contacts() {
    if (is_stopped_) return add_idle("contacts", "");
    if (!v_.in_contact())
      return add("contacts", false,
                 fly_past() ? "on their ways they come no nearer to each other than contacts are looked for"
                            : fmt::format("no features are in contact by contact.points = \"{}\"",
                                          name_of(world_.parameters.contact.points)));
    const Collision& c = deepest();
    add("contacts", true,
        fmt::format("{}, the smallest gap is {}, normal ({:.4g}, {:.4g}, {:.4g}) from '{}' to '{}'{}",
                    several(v_.contacts.size(), "contact"), metres(c.gap), c.normal.x() + 0.0, c.normal.y() + 0.0,
                    c.normal.z() + 0.0, v_.name_b, v_.name_a,
                    c.meeting ? fmt::format(": of where they meet, {:.4g} s later", c.meeting->time) : ""),
        {{"contacts", static_cast<double>(v_.contacts.size())},
         {"met_after_s", c.meeting ? c.meeting->time : 0.0},
         {"gap_m", c.gap},
         {"normal_x", c.normal.x()},
         {"normal_y", c.normal.y()},
         {"normal_z", c.normal.z()}});
  }

  void reduction() {
    if (is_stopped_) return add_idle("reduction", "");
    const std::size_t kept = v_.contacts.size();
    const std::size_t found = kept + static_cast<std::size_t>(std::count_if(
                                         step_.dropped.begin(), step_.dropped.end(),
                                         [&](const Collision& c) { return c.body_a == v_.a && c.body_b == v_.b; }));
    add("reduction", true,
        fmt::format("{} found, {} handed to the response{}", found, kept,
                    found > kept ? ": the others can't come to carry before these do" : ""),
        {{"found", static_cast<double>(found)}, {"kept", static_cast<double>(kept)}});
  }

  const World& world_;
  const SubStep& step_;
  const Body &a_, &b_;
  const Collider &of_a_, &of_b_;
  bool is_self_, is_stopped_ = false, is_listed_ = false;
  double margin_ = 0.0;
  PairVerdict v_;
};

void add_response(PairVerdict& v, const SubStep& step) {
  if (!v.in_contact()) return v.filters.push_back({"response", not_asked, "", {}});
  std::size_t solved = 0, carrying = 0;
  double impulse = 0.0;
  for (const GroupResult& group : step.results)
    for (const SolvedContact& c : group.solved) {
      if (c.collision.body_a != v.a || c.collision.body_b != v.b) continue;
      ++solved;
      carrying += c.lambda.x() > 0.0 ? 1 : 0;
      impulse += c.lambda.x();
    }
  v.filters.push_back({"response",
                       solved > 0 ? passes : stops,
                       fmt::format("{} of {} carr{} an impulse, {:.4g} N s along their normals in all", carrying,
                                   several(solved, "contact"), carrying == 1 ? "ies" : "y", impulse),
                       {{"contacts", static_cast<double>(solved)},
                        {"carrying", static_cast<double>(carrying)},
                        {"impulse_N_s", impulse}}});
}

}  // namespace

std::string_view name_of(FilterVerdict::Outcome outcome) {
  constexpr std::string_view kNames[] = {"passes", "stops", "not asked"};
  return kNames[static_cast<int>(outcome)];
}

const FilterVerdict* PairVerdict::find(std::string_view filter) const {
  const auto it =
      std::find_if(filters.begin(), filters.end(), [&](const FilterVerdict& f) { return f.filter == filter; });
  return it == filters.end() ? nullptr : &*it;
}

const FilterVerdict* PairVerdict::stopped_by() const {
  const auto it =
      std::find_if(filters.begin(), filters.end(), [](const FilterVerdict& f) { return f.outcome == stops; });
  return it == filters.end() ? nullptr : &*it;
}

double activation_between(const Parameters& parameters, const Body& a, const Body& b) {
  return parameters.contact.activation(pair_size(a, b));
}

PairVerdict pair_verdict(const World& world, const SubStep& step, BodyIndex a, BodyIndex b, NearestSearch& search) {
  return Report(world, step, a, b, search).take();
}

const Passage* passage_of(const std::optional<UnsafeMotion>& unsafe, BodyIndex a, BodyIndex b) {
  if (!unsafe) return nullptr;
  for (const UnsafeMotion::Pair& pair : unsafe->pairs)
    if (pair.a == a && pair.b == b && !pair.passages.empty()) return &pair.passages.front();
  return nullptr;
}

void add_outcome(PairVerdict& v, const World& world, const SubStep& step, MotionGuard& guard, const Passage* passage) {
  add_response(v, step);
  const auto add = [&](FilterVerdict::Outcome outcome, std::string words, Numbers numbers = {}) {
    v.filters.push_back({"time_of_impact", outcome, std::move(words), std::move(numbers)});
  };
  if (v.a == v.b) return add(not_asked, "a body's way past itself is not looked at");
  const MotionGuard::PairMotion motion = guard.motion_of(world.bodies(), v.a, v.b);
  if (motion.is_planar && v.undone.motions == 0 && passage == nullptr)
    return add(not_asked, "a plane has no other side to get to");
  if (!may_respond(world.bodies(), v.a, v.b)) return add(not_asked, "nothing would come of it");
  Numbers numbers = {
      {"way_a_m", motion.way_a}, {"way_b_m", motion.way_b}, {"approach_m", motion.approach}, {"safe_m", motion.safe}};
  if (v.undone.motions > 0) {
    numbers.push_back({"time_s", v.undone.first_time});
    return add(passes,
               fmt::format("one would pass the other at {:.6g} s: the motion was taken back and cut short ({})",
                           v.undone.first_time, several(static_cast<std::size_t>(v.undone.motions), "time")),
               std::move(numbers));
  }
  if (passage != nullptr) {
    const double time = step.time + passage->time * step.time_step;
    numbers.push_back({"time_s", time});
    return add(stops, fmt::format("one passes the other at {:.6g} s, and is let go", time), std::move(numbers));
  }
  const Continuous which = watching(world.parameters);
  if (!motion.meets) return add(not_asked, "the boxes round their ways don't meet", std::move(numbers));
  const std::string words =
      fmt::format("they approached by {} at most, {} are safe", metres(motion.approach), metres(motion.safe));
  if (which == Continuous::off && motion.is_at_risk())
    return add(stops, words + ": not looked at, since narrow_phase.continuous is \"off\"", std::move(numbers));
  if (which == Continuous::on || motion.is_at_risk())
    return add(passes, words + ": looked at, neither passes the other", std::move(numbers));
  add(not_asked, words, std::move(numbers));
}

}  // namespace impinge
