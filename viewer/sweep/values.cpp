#include "viewer/sweep/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "engine/core/error.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace {

constexpr int kMostValues = 1'000'000;

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

// at marks that stand in no brackets and no quotes
std::vector<std::string> split_outside(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0)
      quote = c == quote ? 0 : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '[' || c == '{' || c == '(')
      ++depth;
    else if (c == ']' || c == '}' || c == ')')
      --depth;
    if (c == mark && depth == 0 && quote == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (std::string& part : parts) part = trimmed(part);
  return parts;
}

template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

// both ends exact; between them twelve digits, so that log(1,64,7) gives 2, 4, 8 and not their neighbours
std::vector<double> spaced(const std::string& place, const std::vector<std::string>& parts, bool logarithmic) {
  const char* form = logarithmic ? "log(lo,hi,n)" : "lo:hi:n";
  if (parts.size() != 3)
    refuse(place, fmt::format("{} parts in a range", parts.size()), fmt::format("{} is wanted", form),
           "write all three");
  const auto low = number_in<double>(parts[0]), high = number_in<double>(parts[1]);
  const auto count = number_in<int>(parts[2]);
  if (!low || !high || !std::isfinite(*low) || !std::isfinite(*high))
    refuse(place, fmt::format("'{}' to '{}'", parts[0], parts[1]),
           fmt::format("{} with two finite numbers is wanted", form), "change the ends");
  if (!count || *count < 1 || *count > kMostValues)
    refuse(place, fmt::format("n is '{}', an empty range", parts[2]),
           fmt::format("a whole number from 1 to {} is wanted", kMostValues), "change n");
  if (logarithmic && (*low <= 0.0 || *high <= 0.0))
    refuse(place, fmt::format("log from {} to {}", parts[0], parts[1]), "ends greater than 0 are wanted",
           "change the ends");
  if (*count == 1 && *low != *high)
    refuse(place, "one value between two ends", "n of at least 2 is wanted", "raise n, or write the value alone");
  std::vector<double> values;
  for (int i = 0; i < *count; ++i) {
    if (i == 0)
      values.push_back(*low);
    else if (i == *count - 1)
      values.push_back(*high);
    else {
      const double t = static_cast<double>(i) / (*count - 1);
      const double value = logarithmic ? *low * std::pow(*high / *low, t) : *low + (*high - *low) * t;
      values.push_back(*number_in<double>(fmt::format("{:.12g}", value)));
    }
  }
  return values;
}

std::vector<std::string> range_texts(const std::vector<double>& values, const Parameter* row) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  const bool whole = row != nullptr && row->kind == ParameterKind::integer;
  for (const double value : values) texts.push_back(shortest(whole ? std::round(value) : value));
  return texts;
}

}  // namespace

SweepAxis read_sweep_axis(const char* option, const SweepSetting& setting, const Session& session,
                          const std::function<void(const std::string&)>& load) {
  const std::string place = setting.where(option), &text = setting.text;
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    refuse(place, setting.place.empty() ? "no PATH=SPEC" : fmt::format("'{}' is no PATH=SPEC", text),
           "a parameter's path, =, and its values are wanted", "write contact.friction=0.1,0.5");
  SweepAxis axis;
  axis.path = trimmed(text.substr(0, equals));
  const std::vector<std::string>* renamed = session.rows().renamed(axis.path);
  const Parameter* row = session.rows().find(renamed == nullptr ? axis.path : renamed->front());
  if (row == nullptr && axis.path.rfind("body.", 0) != 0)
    refuse(place, session.rows().unknown_message(axis.path), "a parameter or body.NAME.KEY is wanted",
           "change the path");

  if (axis.path == "record.columns")
    refuse(place, "record.columns, which says what all jobs are measured by", "the same in all jobs is wanted",
           "give it by --set");
  const std::string spec = trimmed(text.substr(equals + 1));
  if (spec.empty()) refuse(place, "no values", "a,b,c or lo:hi:n or log(lo,hi,n) is wanted", "name some");
  const bool logarithmic = spec.rfind("log(", 0) == 0 && spec.back() == ')';
  const std::vector<std::string> colons = split_outside(spec, ':');
  if (!setting.values.empty())
    axis.values = setting.values;
  else if (logarithmic)
    axis.values = range_texts(spaced(place, split_outside(spec.substr(4, spec.size() - 5), ','), true), row);
  else if (colons.size() > 1)
    axis.values = range_texts(spaced(place, colons, false), row);
  else
    axis.values = split_outside(spec, ',');

  std::set<std::string> seen;
  for (std::string& value : axis.values) {
    if (value.empty())
      refuse(place, "an empty value", "values with commas between them are wanted", "take the extra comma out");
    try {
      if (row != nullptr) {
        const ParameterValue checked = parse_value(*row, value);
        if (row->kind != ParameterKind::text_list) value = format_value(checked);
      } else {
        load(axis.path + "=" + value);
        value = format_toml(parse_toml_value(value, place));
      }
    } catch (const InputError& error) {
      const std::string message = error.what(), tried = fmt::format("{}={}: ", axis.path, value);
      if (message.rfind("--set " + tried, 0) == 0)
        throw InputError(fmt::format("{}{}{}{}", setting.place.empty() ? option : place,
                                     setting.place.empty() ? " " : ": ", tried, message.substr(6 + tried.size())));
      throw InputError(message.rfind(place, 0) == 0 ? message
                                                    : fmt::format("{}: {}; change the value", place, message));
    }
    if (!seen.insert(value).second)
      refuse(place, fmt::format("{} twice", value), "values that differ are wanted", "leave one out");
  }
  return axis;
}

bool is_numeric(const SweepAxis& axis) {
  return std::all_of(axis.values.begin(), axis.values.end(),
                     [](const std::string& value) { return number_in<double>(value).has_value(); });
}

std::size_t count_sweep_jobs(const std::vector<SweepAxis>& axes, const std::vector<SweepSetting>& settings, bool zip,
                             std::size_t most) {
  std::set<std::string> paths;
  std::size_t count = zip ? axes.front().values.size() : 1;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const SweepAxis& axis = axes[i];
    const std::string place = settings[i].place.empty() ? "--vary " + axis.path : settings[i].place;
    if (!paths.insert(axis.path).second)
      refuse(place, axis.path + " varied twice", "a path once is wanted", "put its values into one list");
    if (zip && axis.values.size() != count)
      refuse(place, fmt::format("{} values of {}", axis.values.size(), axis.path),
             fmt::format("--zip wants as many as {} has, {}", axes.front().path, count), "add or leave out values");
    if (!zip)
      count = axis.values.size() > std::size_t{1'000'000'000} / count ? std::size_t{1'000'000'000}
                                                                      : count * axis.values.size();
  }
  if (count > most)
    refuse(settings.front().place.empty() ? "--vary" : settings.front().place,
           fmt::format("{}{} jobs", count, count >= 1'000'000'000 ? " or more" : ""),
           fmt::format("at most {} are taken", most), most < 1'000'000 ? "vary less, or say --yes" : "vary less");
  return count;
}

std::vector<std::string> sweep_job_values(const std::vector<SweepAxis>& axes, bool zip, std::size_t job) {
  std::vector<std::string> values(axes.size());
  for (std::size_t i = axes.size(); i-- > 0;) {
    const std::vector<std::string>& all = axes[i].values;
    values[i] = all[zip ? job : job % all.size()];
    if (!zip) job /= all.size();
  }
  return values;
}

int sweep_job_level(const std::vector<SweepAxis>& axes, bool zip, std::size_t job) {
  int level = 0;
  for (std::size_t i = axes.size(); i-- > 0;) {
    const std::size_t count = axes[i].values.size(), at = zip ? job : job % count;
    if (!zip) job /= count;
    if (!is_numeric(axes[i])) continue;
    int own = 0;
    for (std::size_t low = 0, high = count - 1; at != low && at != high;) {
      const std::size_t middle = low + (high - low) / 2;
      ++own;
      if (at == middle) break;
      (at < middle ? high : low) = middle;
    }
    level = std::max(level, own);
  }
  return level;
}

}  // namespace impinge
