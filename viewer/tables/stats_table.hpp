// stats.csv: one row a frame, its columns those of the table of figures (engine/world/figures.hpp) and behind them those
// that the scene asks for (record.columns).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/world/figures.hpp"

namespace impinge {

/// Throws DivergenceError with frame and column where a figure is not finite: such a row is not written.
void check_figures(const FrameStats& stats, bool judged);

/// What a file's columns depend on.
struct StatsShape {
  // a word for the figures alone, as most have them
  StatsShape(bool is_judged, std::optional<std::vector<std::string>> own_names = std::vector<std::string>())
      : judged(is_judged), own(std::move(own_names)) {}
  bool judged;                                  ///< with those of --judge
  std::optional<std::vector<std::string>> own;  ///< the scene's, last; none: whatever the file has
};

/// What a line of stats.csv says. Throws InputError on a line of another shape.
struct StatsLine {
  /// in the order of figure_names(); not a number where the file, an older version's, has no such column
  std::vector<double> figures;
  std::string state_hash;
  std::vector<double> own = {};  ///< the scene's own columns; not a number where one had none
};

/// The columns of one file.
class StatsColumns {
 public:
  /// All of this version.
  explicit StatsColumns(const StatsShape& shape);
  /// Those that a file's header names, which may lack columns that have come later. Throws InputError (without a place)
  /// for a header that no version wrote of that shape.
  StatsColumns(std::string_view header, const StatsShape& shape);

  /// The header line, without line end.
  std::string header() const;
  /// A frame's line, without line end; numbers in their shortest form that reads back exactly. `own`: a value for each of
  /// own().
  std::string row(const FrameStats& stats, std::span<const double> own = {}) const;
  /// The same of figures in the order of figure_names().
  std::string row(std::span<const double> figures, std::uint64_t state_hash, std::span<const double> own = {}) const;
  /// Throws InputError (without a place) for a line of another shape.
  StatsLine parse(std::string_view line) const;
  const std::vector<std::string>& own() const { return own_; }

 private:
  struct Column {
    const Figure* figure;
    std::size_t place;  // among the numbers; of the hash none
  };
  void add(const Figure& figure);
  bool has(const Figure& figure) const;

  std::vector<Column> columns_;
  std::vector<std::string> own_;
  bool judged_;
};

/// The rows of a stats.csv's text, one after another. What an interrupted run left of its last line is no row.
class StatsReader {
 public:
  /// Throws InputError at the header if it is another one. `file`, for messages, and `text` must outlive this.
  StatsReader(std::string_view text, const StatsShape& shape, const std::string& file);
  const StatsColumns& columns() const { return columns_; }
  /// False at the end. Throws InputError at the line if it is no row.
  bool next(StatsLine& row);

 private:
  std::string_view rest_;
  const std::string& file_;
  int line_ = 1;
  StatsColumns columns_;
};

/// Leading rows of a stats.csv's text that are whole and belong to frames 0, 1, 2, ...
std::vector<StatsLine> whole_rows(std::string_view text, const StatsShape& shape);

}  // namespace impinge
