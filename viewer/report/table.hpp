// results.csv as the report shows it: whatever columns it has, each with a label, a unit and what it means.
#pragma once

#include <string>
#include <vector>

#include "engine/core/parameter.hpp"

namespace impinge {

/// Lines of comma-separated cells; quotes may hold commas, quotes and line ends.
std::vector<std::vector<std::string>> parse_csv(const std::string& text);

struct ReportColumn {
  enum Kind { hash, varied, status, reason, doubts, reference, text, figure, error, time, spread };
  std::string name;  ///< as in results.csv
  std::string label, unit, doc;
  Kind kind = figure;
  bool is_numeric = false;
  bool is_main = false;       ///< shown before anybody asks for all columns
  int distinct = 0;           ///< different values
  bool in_reference = false;  ///< a varied path that the reference sets, or that a formula is the truth for
  bool is_joined =
      false;  ///< jobs that differ in nothing but such columns belong to one line of a plot, which goes along them
};
const char* kind_name(ReportColumn::Kind kind);

struct ReportTable {
  std::vector<ReportColumn> columns;
  std::vector<std::vector<std::string>> rows;                               ///< cells as they stand in the file
  int column(const std::string& name) const;                                ///< -1: none
  double number(std::size_t row, int column) const;                         ///< NaN where there is none
  const std::string& cell(std::size_t row, const std::string& name) const;  ///< "" without such a column
  /// Whether some row has a number greater than 0 there.
  bool has_positive(int column) const;
  /// Rows that no other beats: none is at most as large in both columns and smaller in one. Only positive numbers
  /// count, and only rows whose answers nothing puts in doubt.
  std::vector<bool> best(int x, int y) const;
  std::string job_name(std::size_t row, const std::vector<int>& by) const;  ///< the values of some varied columns
};

/// `rows` gives units and docs of the varied paths.
ReportTable read_report_table(const std::string& csv, const std::vector<std::string>& paths,
                              const std::vector<std::string>& reference, const ParameterSet& rows);

}  // namespace impinge
