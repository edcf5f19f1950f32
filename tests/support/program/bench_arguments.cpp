#include "tests/support/program/bench_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <system_error>

namespace impinge::test {
namespace {

template <class Number>
std::optional<Number> number_in(const std::string& word) {
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

template <class Number>
std::string allowed(const Limits<Number>& limits) {
  const Limits<Number> any;
  const std::string kind = std::is_integral_v<Number> ? "a whole number" : "a number";
  if (limits.least == any.least && limits.most == any.most) return kind;
  if (limits.most == any.most) return fmt::format("{} of {} or more", kind, limits.least);
  return fmt::format("{} from {} to {}", kind, limits.least, limits.most);
}

template <class Number>
BenchArguments::Check taker(Number& value, const Limits<Number>& limits) {
  return [&value, limits](const std::string& word) -> std::string {
    const std::optional<Number> found = number_in<Number>(word);
    // a number that is none is not between any two
    if (!found || !(*found >= limits.least && *found <= limits.most)) return allowed(limits);
    value = *found;
    return "";
  };
}

bool looks_like_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && !number_in<double>(word);
}

}  // namespace

BenchArguments::BenchArguments(std::string program, std::string measures)
    : program_(std::move(program)), measures_(std::move(measures)) {}

void BenchArguments::number(const std::string& name, int& value, Limits<int> limits, const std::string& about) {
  arguments_.push_back(
      {name, fmt::format("{}; {}", about, allowed(limits)), std::to_string(value), taker(value, limits)});
}

void BenchArguments::number(const std::string& name, double& value, Limits<double> limits, const std::string& about) {
  arguments_.push_back(
      {name, fmt::format("{}; {}", about, allowed(limits)), fmt::format("{}", value), taker(value, limits)});
}

void BenchArguments::word(const std::string& name, std::string& value, const Check& check, const std::string& about) {
  arguments_.push_back({name, about, value, [&value, check](const std::string& word) {
                          std::string fault = check ? check(word) : "";
                          if (fault.empty()) value = word;
                          return fault;
                        }});
}

void BenchArguments::words(const std::string& name, std::vector<std::string>& values, const Check& check,
                           const std::string& about) {
  const auto is_given = std::make_shared<bool>(false);
  arguments_.push_back({name, about, fmt::format("{}", fmt::join(values, " ")),
                        [&values, check, is_given](const std::string& word) {
                          std::string fault = check ? check(word) : "";
                          if (!fault.empty()) return fault;
                          if (!*is_given) values.clear();
                          *is_given = true;
                          values.push_back(word);
                          return fault;
                        },
                        true});
}

std::optional<BenchArguments::Ending> BenchArguments::read(const std::vector<std::string>& words) const {
  if (std::any_of(words.begin(), words.end(), [](const std::string& w) { return w == "--help" || w == "-h"; }))
    return Ending{0, help()};
  const auto next_place = [&](auto from) {
    return std::find_if(from, arguments_.end(), [](const Argument& a) { return !a.is_option(); });
  };
  auto place = next_place(arguments_.begin());
  for (std::size_t i = 0; i < words.size(); ++i) {
    auto argument = place;
    const bool is_option = looks_like_option(words[i]);
    if (is_option) {
      argument = std::find_if(arguments_.begin(), arguments_.end(),
                              [&](const Argument& a) { return a.is_option() && a.name == words[i]; });
      if (argument == arguments_.end()) return refusal(fmt::format("there is no option '{}'", words[i]));
      if (i + 1 == words.size()) return refusal(fmt::format("option {} lacks its value", words[i]));
      ++i;
    } else if (argument == arguments_.end()) {
      return refusal(fmt::format("'{}' is one argument too many", words[i]));
    }
    if (const std::string fault = argument->take(words[i]); !fault.empty())
      return refusal(fmt::format("{}: found '{}', allowed is {}", argument->name, words[i], fault));
    if (!is_option && !place->is_last) place = next_place(place + 1);
  }
  return {};
}

void BenchArguments::read_or_exit(int argc, char** argv) const {
  const std::optional<Ending> ending = read(std::vector<std::string>(argv + 1, argv + std::max(argc, 1)));
  if (!ending) return;
  std::fputs(ending->text.c_str(), ending->code == 0 ? stdout : stderr);
  std::exit(ending->code);
}

std::string BenchArguments::usage() const {
  std::string line = "usage: " + program_;
  for (const Argument& a : arguments_)
    line += a.is_option() ? fmt::format(" [{} VALUE]", a.name) : fmt::format(" [{}{}]", a.name, a.is_last ? " …" : "");
  return line + "\n";
}

std::string BenchArguments::help() const {
  std::string text = measures_ + "\n\n" + usage();
  for (const Argument& a : arguments_)
    text += fmt::format("  {:<14} {}{}\n", a.name, a.about,
                        a.unless_given.empty() ? "" : fmt::format(" (unless given: {})", a.unless_given));
  return text;
}

BenchArguments::Ending BenchArguments::refusal(const std::string& what) const {
  return {2, fmt::format("{}: {}; {} --help tells what it takes\n", program_, what, program_)};
}

BenchArguments::Check one_of(const std::vector<std::string>& words) {
  return [words](const std::string& word) -> std::string {
    if (std::find(words.begin(), words.end(), word) != words.end()) return "";
    return words.size() == 1 ? words[0] : fmt::format("one of {}", fmt::join(words, ", "));
  };
}

std::string file_fault(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) ? "" : "a file that is there";
}

std::string number_fault(const std::string& word) { return number_in<double>(word) ? "" : "a number"; }

std::string whole_number_fault(const std::string& word) {
  const std::optional<int> found = number_in<int>(word);
  return found && *found > 0 ? "" : "a whole number of 1 or more";
}

}  // namespace impinge::test
