// Traps that a scene may hold, and what impinge check says of them.
#pragma once

#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <regex>

#include "engine/core/types.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"

namespace impinge::test {

inline std::string body(const std::string& name, const std::string& keys, const char* kind = "dynamic") {
  return fmt::format("[[body]]\nname = \"{}\"\nkind = \"{}\"\n{}\n", name, kind, keys);
}

inline std::string ball(const std::string& name, double radius, const Vec3& at, const std::string& more = "") {
  return body(name, fmt::format("shape = {{ sphere = {{ radius = {} }} }}\nposition = [{}, {}, {}]\n{}", radius, at.x(),
                                at.y(), at.z(), more.empty() ? "material = { density = 1000 }" : more));
}

/// The warnings of a text, by code.
inline std::multimap<std::string, std::string> warnings_in(const std::string& out) {
  std::multimap<std::string, std::string> found;
  const std::regex line("warning: ([a-z-]+): ([^\n]*)\n");
  for (std::sregex_iterator it(out.begin(), out.end(), line), end; it != end; ++it) found.emplace((*it)[1], (*it)[2]);
  return found;
}

/// "0.25 m", "3.1 µm", "12 kg", "5 ms" after `before`, in SI; not a number where there is none.
inline double quantity_after(const std::string& text, const std::string& before) {
  const std::size_t at = text.find(before);
  if (at == std::string::npos) return NAN;
  static const std::map<std::string, double> kUnits = {
      {"nm", 1e-9}, {"µm", 1e-6}, {"mm", 1e-3}, {"m", 1.0},   {"km", 1e3},  {"µg", 1e-9}, {"mg", 1e-6},
      {"g", 1e-3},  {"kg", 1.0},  {"t", 1e3},   {"ns", 1e-9}, {"µs", 1e-6}, {"ms", 1e-3}, {"s", 1.0}};
  const std::string rest = text.substr(at + before.size());
  std::size_t digits = 0;
  const double value = std::stod(rest, &digits);
  std::size_t begin = rest.find_first_not_of(' ', digits), end = begin;
  while (end < rest.size() && rest[end] != ' ' && rest[end] != ',' && rest[end] != ':' && rest[end] != ')') ++end;
  const auto unit = kUnits.find(rest.substr(begin, end - begin));
  return unit == kUnits.end() ? value : value * unit->second;
}

struct Trap {
  const char* what;
  const char* code;
  std::string scene;
  std::vector<std::string> names = {};  ///< that the warning must hold
  std::string before = {};              ///< of the number
  double number = NAN;                  ///< SI
  std::vector<std::string> options = {};
  double within = 6e-3;  ///< relative: three digits are printed
};

inline void check_trap(const TempFolder& folder, const Trap& trap) {
  CAPTURE(trap.what);
  folder.write("trap.toml", trap.scene);
  std::vector<std::string> words = {"check", "trap.toml"};
  words.insert(words.end(), trap.options.begin(), trap.options.end());
  const Outcome outcome = impinge_run(folder.path(), words);
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.code == 0);
  const auto found = warnings_in(outcome.out);
  CHECK(found.count(trap.code) == found.size());  // and nothing else
  REQUIRE(found.count(trap.code) >= 1);
  const std::string& text = found.find(trap.code)->second;
  for (const std::string& name : trap.names) CHECK(text.find(name) != std::string::npos);
  if (!trap.before.empty()) CHECK(quantity_after(text, trap.before) == Approx(trap.number).epsilon(trap.within));

  words.emplace_back("--strict");
  const Outcome strict = impinge_run(folder.path(), words);
  CHECK(strict.code == 2);
  CHECK(strict.error_lines() == 1);
  words.insert(words.end(), {"--set", fmt::format("check.silence=[{}]", trap.code)});
  const Outcome silenced = impinge_run(folder.path(), words);
  CAPTURE(silenced.out, silenced.err);
  CHECK(silenced.code == 0);
  CHECK(warnings_in(silenced.out).empty());
  CHECK(silenced.out.find("silenced by check.silence") != std::string::npos);
}

}  // namespace impinge::test
