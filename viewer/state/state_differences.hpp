// In what the states of two worlds with the same bodies differ.
#pragma once

#include <string>
#include <vector>

#include "engine/world/step_record.hpp"

namespace impinge {

/// How far a body's state differs in one field.
struct FieldDifference {
  std::string body, field, unit;
  double largest = 0.0;  ///< in `unit`
  std::string where;     ///< "node 17", or ""
};

/// Bodies that both have, by name, in the order of A; fields of which no bit differs are left out.
std::vector<FieldDifference> field_differences(const StepRecord& a, const StepRecord& b);

}  // namespace impinge
