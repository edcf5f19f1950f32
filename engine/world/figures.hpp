// The one table of a frame's figures: what each is called, its unit and meaning, and where it stands. stats.csv, the
// words of `expect`, `break` and a sweep's columns, the debugger's timeline, the panel of figures, what a snapshot keeps
// of a frame and `impinge list figures` are all made of it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/core/archive.hpp"
#include "engine/world/step_record.hpp"

namespace impinge {

/// state: comes out the same whenever and wherever the frame is made. time: wall-clock milliseconds, of no two runs the
/// same; its name, and no other one, ends in _ms. judged: there only where somebody judges (--judge).
enum class FigureKind { state, time, judged };
std::string_view kind_name(FigureKind kind);

/// One component of a vector.
struct VectorFigure {
  Vec3 FrameStats::*vector;
  int axis;
};
/// Where a figure stands, or what it is made of.
using FigureSource = std::variant<int FrameStats::*, std::int64_t FrameStats::*, double FrameStats::*, VectorFigure,
                                  double StageTimes::*, std::uint64_t FrameStats::*, SolveEnd FrameStats::*,
                                  double (*)(const FrameStats&)>;

struct Figure {
  std::string_view name;  ///< the column of stats.csv
  std::string_view unit;  ///< "m", "J", "" for a number without one
  FigureKind kind;
  FigureSource source;
  std::string_view doc;  ///< one sentence

  /// The state's hash: a word of 16 hex digits, the only column that has no number.
  bool is_hash() const { return std::holds_alternative<std::uint64_t FrameStats::*>(source); }
  /// A word for each number, in files.
  bool is_word() const { return std::holds_alternative<SolveEnd FrameStats::*>(source); }
  /// A number that counts something.
  bool is_whole() const {
    return std::holds_alternative<int FrameStats::*>(source) ||
           std::holds_alternative<std::int64_t FrameStats::*>(source);
  }
  /// Of a hash it is 0.
  double value(const FrameStats& stats) const;
};

/// All of them, in the order of the columns, which is a contract: a new one comes last.
std::span<const Figure> figures();
/// The figure of that name, or nullptr.
const Figure* find_figure(std::string_view name);

/// The figures that are numbers, in order, with or without those that somebody judges; and a frame's values for them.
const std::vector<std::string>& figure_names(bool judged);
std::vector<double> figure_values(const FrameStats& stats, bool judged);
/// The first of those that is not a finite number, or nullptr.
const Figure* first_not_finite(const FrameStats& stats, bool judged);
/// Where a figure stands among figure_names(judged). Throws InternalError if it does not.
std::size_t figure_index(std::string_view name, bool judged = false);

/// The figures of kind `state` that are not made of others, as a snapshot keeps them.
void put_figures(ByteWriter& out, const FrameStats& stats);
/// What was kept before a column came into being lacks it: that figure stays as it is. Throws InputError where there are
/// more than this version knows.
void get_figures(ByteReader& in, FrameStats& stats);

}  // namespace impinge
