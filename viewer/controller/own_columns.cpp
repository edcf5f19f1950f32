#include "viewer/controller/own_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "engine/core/rows.hpp"
#include "engine/world/figures.hpp"

namespace impinge {

namespace {

const std::string kPath = "record.columns";

bool is_column_name(std::string_view name) {
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0 &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; });
}

bool holds_a_time(const Expression& expression, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const Figure* figure = find_figure(names[i]); figure != nullptr && figure->kind == FigureKind::time)
      if (expression.uses(i)) return true;
  return false;
}

}  // namespace

OwnColumns::OwnColumns(const std::vector<std::string>& texts, const ExpressionWords& condition,
                       const std::string& place) {
  ExpressionWords words = condition;
  words.takes_number = true;
  for (const std::string& text : texts) {
    const PlacedText whole{text, &kPath, 1, 1};
    const auto refuse = [&](const std::string& found, const char* allowed, const char* remedy) {
      throw InputError(fmt::format("{}: '{}' of {}: {}; {}; {}", place, text, kPath, found, allowed, remedy));
    };
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      refuse("no NAME = EXPR", "a name, = and an expression are wanted", "write \"x = position_x(BODY)\"");
    const std::string name(trimmed(std::string_view(text).substr(0, equals)));
    if (!is_column_name(name))
      refuse(fmt::format("'{}' as a name", name), "letters, digits and _ are wanted, and no digit first", "rename it");
    if (find_figure(name) != nullptr || std::find(names_.begin(), names_.end(), name) != names_.end())
      refuse(fmt::format("a second column '{}'", name), "names must differ, also from those of impinge list figures",
             "rename it");
    try {
      expressions_.emplace_back(whole.part(equals + 1), words);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", place, error.what()));
    }
    names_.push_back(name);
    const bool is_time = holds_a_time(expressions_.back(), words.names);
    if (is_time != name.ends_with("_ms"))
      refuse(fmt::format("'{}' holds {} time", name, is_time ? "a" : "no"),
             "columns of times, and only they, end in _ms", "rename it");
  }
}

std::vector<double> OwnColumns::values(std::span<const double> figures, const StepRecord& record, Bodies& bodies) {
  std::vector<double> values;
  for (const Expression& expression : expressions_)
    values.push_back(expression.evaluate(reader_.values(expression, figures, record, bodies)));
  return values;
}

void bind_own_columns(ParameterSet& rows, std::vector<std::string>& texts) {
  Parameter row;
  row.path = "columns";
  row.kind = ParameterKind::text_list;
  row.doc =
      "Further columns of stats.csv, each \"NAME = EXPR\" over figures of bodies and the other columns, as in "
      "[\"x = position_x(crate)\", \"push = force(crate,floor)\"]; see impinge list body_figures. A sweep's columns "
      "take them too.";
  row.initial = texts;
  row.live = false;
  row.get = [&texts] { return ParameterValue(texts); };
  row.set = [&texts](const ParameterValue& value) { texts = std::get<std::vector<std::string>>(value); };
  Rows(rows, "record").add(std::move(row));
}

}  // namespace impinge
