// The columns of stats.csv that a scene asks for beside those of every run: `record.columns = ["x = position_x(box)"]`.
#pragma once

#include "viewer/controller/condition_values.hpp"

namespace impinge {

class OwnColumns {
 public:
  OwnColumns() = default;
  /// Each text is NAME = EXPR, by the grammar of conditions, of which the whole may be a number. Throws InputError for a
  /// name that is taken or has odd letters, one that ends in _ms where no time is in it, or the other way round, and an
  /// expression that is wrong. `place`: where they were given.
  OwnColumns(const std::vector<std::string>& texts, const ExpressionWords& words, const std::string& place);

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<Expression>& expressions() const { return expressions_; }
  /// A value a column; not a number where nobody can say. `figures` by the words' names; bodies stand where the record
  /// has them.
  std::vector<double> values(std::span<const double> figures, const StepRecord& record, Bodies& bodies);

 private:
  std::vector<std::string> names_;
  std::vector<Expression> expressions_;
  ConditionReader reader_;
};

/// Their row, record.columns, fixed from the first frame on. The set refers to `texts`.
void bind_own_columns(ParameterSet& rows, std::vector<std::string>& texts);

}  // namespace impinge
