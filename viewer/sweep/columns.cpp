#include "viewer/sweep/columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/io/scene/scene_values.hpp"
#include "viewer/sweep/table.hpp"

namespace impinge {

namespace {

struct Function {
  const char* name;
  double (*over)(const std::vector<StatsLine>& frames, std::size_t column);
};

constexpr Function kFunctions[] = {
    {"last", [](const std::vector<StatsLine>& f, std::size_t c) { return f.back().figures[c]; }},
    {"max",
     [](const std::vector<StatsLine>& f, std::size_t c) {
       double most = f.front().figures[c];
       for (const StatsLine& line : f)  // a frame without a number is no frame
         if (std::isnan(most) || line.figures[c] > most) most = line.figures[c];
       return most;
     }},
    {"min",
     [](const std::vector<StatsLine>& f, std::size_t c) {
       double least = f.front().figures[c];
       for (const StatsLine& line : f)
         if (std::isnan(least) || line.figures[c] < least) least = line.figures[c];
       return least;
     }},
    {"mean",
     [](const std::vector<StatsLine>& f, std::size_t c) {
       double sum = 0.0;
       for (const StatsLine& line : f) sum += line.figures[c];
       return sum / static_cast<double>(f.size());
     }},
    {"sum",
     [](const std::vector<StatsLine>& f, std::size_t c) {
       double sum = 0.0;
       for (const StatsLine& line : f) sum += line.figures[c];
       return sum;
     }},
};

/// Columns of stats.csv that are numbers.
std::vector<std::string> numbers_of(const StatsShape& shape) {
  std::vector<std::string> names = figure_names(shape.judged);
  names.insert(names.end(), shape.own->begin(), shape.own->end());
  return names;
}

ExpressionWords column_words(const SweepWords& paths, const StatsShape& shape) {
  const bool judged = shape.judged;
  ExpressionWords words = paths.expression_words();
  words.takes_number = true;
  for (const Function& function : kFunctions)
    for (const std::string& figure : numbers_of(shape))
      words.names.push_back(fmt::format("{}({})", function.name, figure));
  std::vector<std::string> functions;
  for (const Function& function : kFunctions) functions.push_back(function.name);
  words.allowed = fmt::format("{} of a column of stats.csv, as in max(contacts){}, or a varied path ({}) is wanted",
                              fmt::join(functions, ", "), judged ? "" : " (with --judge of judged_... too)",
                              fmt::join(paths.expression_words().names, ", "));
  return words;
}

/// Of a word like max(step_ms).
bool is_of_time(const std::string& word) {
  const std::size_t open = word.find('(');
  if (open == std::string::npos) return false;
  return std::string_view(word).substr(0, word.size() - 1).ends_with("_ms");
}

/// What is asked of bodies is a column of stats.csv first.
void refuse_calls(const std::string& where, const std::string& expression) {
  for (const BodyFigure& figure : body_figures()) {
    const std::string call = std::string(figure.name) + "(";
    const std::size_t at = expression.find(call);
    if (at == std::string::npos ||
        (at > 0 && (std::isalnum(static_cast<unsigned char>(expression[at - 1])) != 0 || expression[at - 1] == '_')))
      continue;
    const std::string asked = expression.substr(at, expression.find(')', at) - at) + ")";
    refuse(where, fmt::format("{}, which asks of bodies", asked),
           "columns of stats.csv are wanted, and a scene may have its own",
           fmt::format("add --set 'record.columns=[\"a = {}\"]' and write last(a)", asked));
  }
}

bool is_name(const std::string& text) {
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) == 0 &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
}

}  // namespace

PlacedSetting::PlacedSetting(const SweepSetting& setting, const char* option, std::size_t begin)
    : text_(setting.text.substr(begin)), file_(option), column_(1 + static_cast<int>(begin)) {
  if (setting.place.empty()) return;
  const std::size_t column = setting.place.rfind(':'), line = setting.place.rfind(':', column - 1);
  file_ = setting.place.substr(0, line);
  line_ = std::atoi(setting.place.c_str() + line + 1);
  column_ += std::atoi(setting.place.c_str() + column + 1);  // one further: the quote
}

SweepWords::SweepWords(const std::vector<SweepAxis>& axes) {
  for (const SweepAxis& axis : axes) {
    words_.names.push_back(axis.path);
    words_.is_text.push_back(!is_numeric(axis));
    if (!words_.is_text.back()) continue;
    for (const std::string& value : axis.values)
      if (std::find(words_.texts.begin(), words_.texts.end(), value) == words_.texts.end())
        words_.texts.push_back(value);
  }
  words_.allowed = fmt::format("the varied paths are allowed: {}", fmt::join(words_.names, ", "));
}

std::vector<double> SweepWords::values(const std::vector<std::string>& job_values) const {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < words_.names.size(); ++i)
    numbers.push_back(words_.is_text[i]
                          ? static_cast<double>(std::find(words_.texts.begin(), words_.texts.end(), job_values[i]) -
                                                words_.texts.begin())
                          : std::strtod(job_values[i].c_str(), nullptr));
  return numbers;
}

SweepColumns::SweepColumns(const std::vector<SweepSetting>& settings, const std::vector<SweepAxis>& axes,
                           const StatsShape& shape)
    : paths_(axes) {
  const ExpressionWords words = column_words(paths_, shape);
  for (const std::string& figure : figure_names(shape.judged)) figures_.push_back(sweep_figure(figure));
  for (std::size_t k = 0; k < shape.own->size(); ++k) figures_.push_back(figure_names(true).size() + k);
  for (const SweepSetting& setting : settings) {
    const std::string where = setting.where("--column");
    const std::size_t equals = setting.text.find('=');
    if (equals == std::string::npos)
      refuse(where, "no NAME=EXPR", "a name, = and an expression are wanted", "write --column 'worst=max(residual)'");
    const std::string name = setting.text.substr(0, equals);
    if (!is_name(name))
      refuse(where, fmt::format("'{}' as a name", name), "letters, digits and _ are wanted, and no digit first",
             "rename it");
    const bool is_taken =
        std::any_of(axes.begin(), axes.end(), [&](const SweepAxis& axis) { return axis.path == name; }) ||
        is_sweep_column(name) || std::find(names_.begin(), names_.end(), name) != names_.end();
    if (is_taken) refuse(where, fmt::format("a second column '{}'", name), "names must differ", "rename it");
    refuse_calls(where, setting.text.substr(equals + 1));
    const PlacedSetting placed(setting, "--column", equals + 1);
    expressions_.emplace_back(placed.text(), words);
    names_.push_back(name);
    bool is_time = false;
    for (std::size_t i = 0; i < words.names.size(); ++i)
      is_time |= is_of_time(words.names[i]) && expressions_.back().uses(i);
    if (is_time != name.ends_with("_ms"))
      refuse(where, is_time ? fmt::format("'{}' holds a time", name) : fmt::format("'{}' holds no time", name),
             "columns of times, and only they, end in _ms", "rename it");
  }
}

std::vector<double> SweepColumns::evaluate(const std::vector<std::string>& job_values,
                                           const std::vector<StatsLine>& frames) const {
  if (names_.empty() || frames.empty())
    return std::vector<double>(names_.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<double> values = paths_.values(job_values), results;
  for (const Function& function : kFunctions)
    for (const std::size_t figure : figures_) values.push_back(function.over(frames, figure));
  for (const Expression& expression : expressions_) results.push_back(expression.evaluate(values));
  return results;
}

}  // namespace impinge
