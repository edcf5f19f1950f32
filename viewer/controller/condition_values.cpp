#include "viewer/controller/condition_values.hpp"

#include <algorithm>
#include <cmath>

#include "engine/step/find_pairs.hpp"

namespace impinge {

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
  const bool is_of_pair = term.function == BodyFunction::gap || term.function == BodyFunction::depth;
  if (bodies[term.a].absent || (is_of_pair && bodies[term.b].absent))  // nobody can say anything of it yet
    return term.function == BodyFunction::contacts || term.function == BodyFunction::depth ||
                   term.function == BodyFunction::force
               ? 0.0
               : NAN;
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
