// The user's own columns, and the words that expressions over a sweep may use.
#pragma once

#include "viewer/controller/expression.hpp"
#include "viewer/sweep/values.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {

/// A setting's text from `begin` on, at its own line and column.
class PlacedSetting {
 public:
  PlacedSetting(const SweepSetting& setting, const char* option, std::size_t begin);
  PlacedText text() const { return {text_, &file_, line_, column_}; }

 private:
  std::string text_, file_;
  int line_ = 1, column_ = 1;
};

/// The varied paths as words: numbers, or texts where one of the values is no number.
class SweepWords {
 public:
  SweepWords() = default;
  explicit SweepWords(const std::vector<SweepAxis>& axes);
  const ExpressionWords& expression_words() const { return words_; }
  /// What the words stand for in a job with these values.
  std::vector<double> values(const std::vector<std::string>& job_values) const;

 private:
  ExpressionWords words_;
};

/// Columns NAME=EXPR over f(COLUMN), f one of last, max, min, mean, sum over the frames and COLUMN one of stats.csv, the
/// scene's own among them, and over the varied paths.
class SweepColumns {
 public:
  SweepColumns() = default;
  /// Throws InputError for a name that is taken or has odd letters, an expression that is wrong, and a name that ends
  /// in _ms where no time is in it, or the other way round. `shape`: of the jobs' stats.csv.
  SweepColumns(const std::vector<SweepSetting>& settings, const std::vector<SweepAxis>& axes, const StatsShape& shape);
  const std::vector<std::string>& names() const { return names_; }
  /// A number a column; not finite where there are no frames or the expression says so. Frames as of sweep_stats().
  std::vector<double> evaluate(const std::vector<std::string>& job_values, const std::vector<StatsLine>& frames) const;

 private:
  SweepWords paths_;
  std::vector<std::size_t> figures_;  // where those that a function may be of stand in a line
  std::vector<std::string> names_;
  std::vector<Expression> expressions_;
};

}  // namespace impinge
