// What the names of a condition stand for at the end of a frame or a sub-step.
#pragma once

#include "engine/bodies/bodies.hpp"
#include "engine/detection/pairs/nearest_features.hpp"
#include "engine/world/step_record.hpp"
#include "viewer/controller/expression.hpp"

namespace impinge {

/// By names: figures; behind them its terms. None: the terms ask of a moment of which only the figures are left.
using ConditionValues = std::function<std::vector<double>(const Expression&)>;

/// A body that a condition asks something of which nobody can say, because it isn't there.
struct MissingBody {
  std::string name;
  bool is_deleted = false;  ///< false: it is yet to be added
};
/// The first of them.
std::optional<MissingBody> missing_body(const Expression& condition, const Bodies& bodies);

/// What conditions of a scene may speak of.
ExpressionWords condition_words(const std::vector<std::string>& figures, const Bodies& bodies);

class ConditionReader {
 public:
  /// The bodies stand where the record has them.
  std::vector<double> values(const Expression& condition, std::span<const double> figures, const StepRecord& record,
                             Bodies& bodies);

 private:
  double value(const BodyTerm& term, const StepRecord& record, Bodies& bodies);
  double gap(BodyIndex a, BodyIndex b, const StepRecord& record, const Bodies& bodies, bool only_overlap);

  NearestSearch search_;
};

}  // namespace impinge
