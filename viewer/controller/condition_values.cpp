#include "viewer/controller/condition_values.hpp"

#include <algorithm>
#include <cmath>

#include "engine/step/find_pairs.hpp"

namespace impinge {

namespace {

bool is_of_pair(const BodyTerm& term) { return info_of(term.function).bodies == 2; }

/// Whether it is 0 where a body is not: nothing touches that.
bool is_of_touch(const BodyTerm& term) {
  return term.function == BodyFunction::contacts || term.function == BodyFunction::depth ||
         term.function == BodyFunction::force;
}

/// Which of the term's bodies is not there, not added yet or deleted; null: they are.
const Body* absent_body(const BodyTerm& term, const Bodies& bodies) {
  if (term.function == BodyFunction::energy_from) return nullptr;  // books are kept of what was done
  if (bodies[term.a].deleted) return &bodies[term.a];
  return is_of_pair(term) && bodies[term.b].deleted ? &bodies[term.b] : nullptr;
}

}  // namespace

std::optional<MissingBody> missing_body(const Expression& condition, const Bodies& bodies) {
  for (const BodyTerm& term : condition.terms())
    if (const Body* body = absent_body(term, bodies); body != nullptr && !is_of_touch(term))
      return MissingBody{body->name, !body->absent};
  return std::nullopt;
}

ExpressionWords condition_words(const std::vector<std::string>& figures, const Bodies& bodies) {
  ExpressionWords words;
  words.names = figures;
  words.bodies = bodies.names();
  for (const Body& body : bodies) words.may_meet_itself.push_back(body.kind() == BodyKind::deformable);
  return words;
}

std::vector<double> ConditionReader::values(const Expression& condition, std::span<const double> figures,
                                            const StepRecord& record, Bodies& bodies) {
  std::vector<double> all(figures.begin(), figures.end());
  for (const BodyTerm& term : condition.terms()) all.push_back(value(term, record, bodies));
  return all;
}

double ConditionReader::value(const BodyTerm& term, const StepRecord& record, Bodies& bodies) {
  if (term.function == BodyFunction::energy_from) return energy_from(record.stats.ledger.get(), term.source, term.a);
  const BodyIndex a(std::min(term.a, term.b)), b(std::max(term.a, term.b));
  if (absent_body(term, bodies) != nullptr) return is_of_touch(term) ? 0.0 : NAN;
  switch (term.function) {
    case BodyFunction::contacts:
      return static_cast<double>(std::count_if(record.contacts.begin(), record.contacts.end(),
                                               [&](const ContactRecord& c) { return c.body_a == a && c.body_b == b; }));
    case BodyFunction::force: {
      double impulse = 0.0;
      for (const ContactRecord& c : record.contacts)
        if (c.body_a == a && c.body_b == b) impulse += c.lambda.x();
      return impulse * std::max(1, record.stats.substeps) / record.frame_time;
    }
    case BodyFunction::depth:
      return std::max(0.0, -gap(a, b, record, bodies, true));
    case BodyFunction::gap:
      return gap(a, b, record, bodies, false);
    case BodyFunction::energy: {
      const Balance of_body = bodies[term.a].balance(record.gravity);
      return of_body.kinetic + of_body.elastic + of_body.potential;
    }
    default: {
      const BodyRecord& body = record.bodies[static_cast<std::size_t>(term.a)];
      return part_of_motion(term.function, body.pose.position, body.velocity);
    }
  }
}

/// The smallest of their contacts' gaps; of two without contacts how far their surfaces are apart. Not a number where
/// neither can be told: one body without contacts with itself, two planes.
double ConditionReader::gap(BodyIndex a, BodyIndex b, const StepRecord& record, const Bodies& bodies,
                            bool only_overlap) {
  double least = INFINITY;
  for (const ContactRecord& c : record.contacts)
    if (c.body_a == a && c.body_b == b) least = std::min(least, c.gap);
  if (least < INFINITY) return least;
  if (a == b) return NAN;
  if (only_overlap && !overlap(bodies[a].bounds(), bodies[b].bounds())) return 0.0;
  std::vector<Collider> colliders;
  make_colliders(bodies, colliders);
  const std::optional<NearestFeatures> nearest = search_.find(colliders, a, b, INFINITY);
  return nearest ? nearest->distance : NAN;
}

}  // namespace impinge
