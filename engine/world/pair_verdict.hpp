// Why two bodies have a contact in a sub-step, or none: what each stage of detection had to say of the pair, with its
// numbers and what they were held against. Taken from the stages' own values and functions while the sub-step is made,
// so that it can't say anything else than what happened.
#pragma once

#include "engine/detection/pairs/nearest_features.hpp"
#include "engine/step/step_watcher.hpp"
#include "engine/world/parameters.hpp"

namespace impinge {

class World;

/// A number with its name, which ends in its unit ("gap_m"), as columns of figures do.
struct NamedNumber {
  std::string_view name;
  double value = 0.0;
};

struct FilterVerdict {
  enum Outcome : std::uint8_t {
    passes,
    stops,     ///< the first of these is why there is no contact
    not_asked  ///< what comes before has stopped the pair, or the filter has no part in it
  };
  std::string_view filter;
  Outcome outcome = passes;
  std::string words;  ///< one sentence, without a full stop
  std::vector<NamedNumber> numbers;
};
std::string_view name_of(FilterVerdict::Outcome outcome);

/// In the order of the stages: kind, asleep, exempt, boxes, broad_phase, candidates, distance, contacts, reduction,
/// response, time_of_impact. The last two come after there is a contact or none.
struct PairVerdict {
  int frame = 0, substep = 0, substeps = 0;  ///< substep from 1; 0: frame 0, where nothing moves
  /// The sub-step was made in, and this is of: the last one, or if they have no contact there, the last that they pushed
  /// each other in.
  int pieces = 1, piece = 1;
  double time = 0.0, time_step = 0.0;  ///< s, when contacts were sought, and until when
  BodyIndex a, b;                      ///< a <= b
  std::string name_a, name_b, shape_a, shape_b;
  BodyKind kind_a = BodyKind::dynamic, kind_b = BodyKind::dynamic;
  Aabb box_a, box_b, swept_a, swept_b;  ///< round the bodies, and as the broad phase had them
  /// Motions of the sub-step that were taken back since the two passed in them, and when the first would have met, s.
  struct Undone {
    int motions = 0;
    double first_time = 0.0;
  } undone;
  std::vector<FilterVerdict> filters;
  std::vector<Collision> contacts;         ///< handed to the response
  std::optional<NearestFeatures> nearest;  ///< none: of one body with itself, or two planes

  bool in_contact() const { return !contacts.empty(); }
  const FilterVerdict* find(std::string_view filter) const;
  /// The filter that stopped the pair, none: null.
  const FilterVerdict* stopped_by() const;
};

/// How near features must come to be a contact, metres.
double activation_between(const Parameters& parameters, const Body& a, const Body& b);

/// When contacts were found and nothing has moved since. a <= b.
PairVerdict pair_verdict(const World& world, const SubStep& step, BodyIndex a, BodyIndex b, NearestSearch& search);
/// After the motion, which is kept: what the response did, and the look back at the motion.
void add_outcome(PairVerdict& verdict, const World& world, const SubStep& step, MotionGuard& guard,
                 const Passage* passage);
/// Where the one of two bodies passes the other in a motion; null: it doesn't, or nobody looked.
const Passage* passage_of(const std::optional<UnsafeMotion>& unsafe, BodyIndex a, BodyIndex b);

}  // namespace impinge
