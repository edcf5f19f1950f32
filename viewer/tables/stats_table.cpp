#include "viewer/tables/stats_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"

namespace impinge {

namespace {

// the first line, without its end; all of a text without one
std::string_view first_line(std::string_view text) { return text.substr(0, text.find('\n')); }

std::string_view take_cell(std::string_view& line) {
  const std::string_view cell = line.substr(0, line.find(','));
  line.remove_prefix(std::min(cell.size() + 1, line.size()));
  return cell;
}

double number_in(std::string_view word, std::string_view column) {
  double number = 0.0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || stop != word.data() + word.size())
    throw InputError(fmt::format("'{}' in column {}; a number is wanted; run the scene again", word, column));
  return number;
}

double number_of(std::string_view word, std::string_view column) {
  for (const SolveEnd end : kSolveEnds)
    if (name_of(end) == word) return static_cast<double>(end);
  throw InputError(
      fmt::format("'{}' in column {}; converged, cap, stalled, contradiction, refused or fixed is wanted; run the "
                  "scene again",
                  word, column));
}

[[noreturn]] void refuse_header() {
  throw InputError("another header; the columns of this version are wanted; run the scene again");
}

}  // namespace

StatsColumns::StatsColumns(const StatsShape& shape)
    : own_(shape.own.value_or(std::vector<std::string>())), judged_(shape.judged) {
  for (const Figure& figure : figures())
    if (judged_ || figure.kind != FigureKind::judged) add(figure);
}

StatsColumns::StatsColumns(std::string_view header, const StatsShape& shape) : judged_(shape.judged) {
  const bool judged = judged_;
  while (!header.empty()) {
    const std::string_view name = take_cell(header);
    const Figure* figure = find_figure(name);
    const bool is_odd = figure == nullptr ? name.empty() || std::find(own_.begin(), own_.end(), name) != own_.end()
                                          : has(*figure) || (figure->kind == FigureKind::judged && !judged);
    if (is_odd || (figure != nullptr && !own_.empty())) refuse_header();
    if (figure != nullptr)
      add(*figure);
    else
      own_.emplace_back(name);
  }
  if (shape.own && own_ != *shape.own) refuse_header();
  // those up to the hash are as old as the file's form
  const std::span<const Figure> oldest = figures().first(1 + (find_figure("state_hash") - figures().data()));
  const bool is_ours =
      columns_.size() >= oldest.size() &&
      std::equal(oldest.begin(), oldest.end(), columns_.begin(),
                 [](const Figure& figure, const Column& column) { return &figure == column.figure; }) &&
      (!judged || has(*find_figure("judged_penetration_m")));
  if (!is_ours) refuse_header();
}

void StatsColumns::add(const Figure& figure) {
  columns_.push_back({&figure, figure.is_hash() ? 0 : figure_index(figure.name, judged_)});
}

bool StatsColumns::has(const Figure& figure) const {
  return std::any_of(columns_.begin(), columns_.end(), [&](const Column& column) { return column.figure == &figure; });
}

std::string StatsColumns::header() const {
  std::string line;
  for (const Column& column : columns_) line += (line.empty() ? "" : ",") + std::string(column.figure->name);
  for (const std::string& name : own_) line += "," + name;
  return line;
}

std::string StatsColumns::row(const FrameStats& stats, std::span<const double> own) const {
  return row(figure_values(stats, judged_), stats.state_hash, own);
}

std::string StatsColumns::row(std::span<const double> figures, std::uint64_t state_hash,
                              std::span<const double> own) const {
  IMPINGE_ASSERT(own.size() == own_.size());
  std::string line;
  for (const auto& [figure, place] : columns_) {
    if (!line.empty()) line += ',';
    if (figure->is_hash())
      line += hex64(state_hash);
    else if (figure->is_word())
      line += name_of(static_cast<SolveEnd>(figures[place]));
    else if (figure->is_whole())
      line += std::to_string(static_cast<std::int64_t>(figures[place]));
    else
      line += shortest(figures[place]);
  }
  // what is no number has no sign either
  for (const double value : own) line += "," + (std::isnan(value) ? std::string("nan") : shortest(value));
  return line;
}

void check_figures(const FrameStats& stats, bool judged) {
  if (const Figure* figure = first_not_finite(stats, judged))
    throw DivergenceError(fmt::format("frame {}: {} is {}, and every figure must be finite; use more sub-steps",
                                      stats.frame, figure->name, figure->value(stats)));
}

StatsLine StatsColumns::parse(std::string_view line) const {
  StatsLine row;
  row.figures.assign(figure_names(judged_).size(), std::numeric_limits<double>::quiet_NaN());
  for (const auto& [figure, place] : columns_) {
    const std::string_view word = take_cell(line);
    if (figure->is_hash()) {
      row.state_hash = std::string(word);
      continue;
    }
    if (figure->is_word()) {
      row.figures[place] = number_of(word, figure->name);
      continue;
    }
    row.figures[place] = number_in(word, figure->name);
  }
  for (const std::string& name : own_) row.own.push_back(number_in(take_cell(line), name));
  if (!line.empty())
    throw InputError(
        fmt::format("'{}' after column {}; a cell for each column of the header is wanted; run the scene again", line,
                    own_.empty() ? columns_.back().figure->name : own_.back()));
  return row;
}

StatsReader::StatsReader(std::string_view text, const StatsShape& shape, const std::string& file)
    : rest_(text), file_(file), columns_(shape) {
  try {
    columns_ = StatsColumns(first_line(text), shape);
    if (first_line(text).size() == text.size()) refuse_header();  // cut off within it
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}:1:1: {}", file_, error.what()));
  }
  rest_.remove_prefix(first_line(text).size() + 1);
}

bool StatsReader::next(StatsLine& row) {
  const std::string_view line = first_line(rest_);
  if (line.size() == rest_.size()) return false;
  ++line_;
  try {
    row = columns_.parse(line);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}:{}:1: {}", file_, line_, error.what()));
  }
  rest_.remove_prefix(line.size() + 1);
  return true;
}

std::vector<StatsLine> whole_rows(std::string_view text, const StatsShape& shape) {
  std::vector<StatsLine> rows;
  try {
    const std::string file = "stats.csv";
    StatsReader reader(text, shape, file);
    for (StatsLine row; reader.next(row); rows.push_back(row))
      if (row.figures[0] != static_cast<double>(rows.size()) || row.state_hash.size() != 16 ||
          row.state_hash.find_first_not_of("0123456789abcdef") != std::string::npos)
        break;
  } catch (const InputError&) {
    // what comes before it is whole
  }
  return rows;
}

}  // namespace impinge
