// The two kinds of problem that impinge step takes.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/core/registry.hpp"

namespace impinge {

struct StepOptions {
  std::string file;                    ///< a frozen step, or a published problem
  std::vector<std::string> responses;  ///< names, empty for all
  std::vector<std::string> lcp;        ///< names of solvers, empty for all
  double tolerance = 1e-8;             ///< relative residual
  int max_iterations = 2000;
  std::string out;  ///< folder for tables and plots, "" for none
};

/// Print what every method makes of the problem. Throw InputError.
void step_published(const StepOptions& options);
void step_frozen(const StepOptions& options);

/// The entries of those names, all of them for no names. Throws InputError naming the nearest where there is none.
template <class Interface>
std::vector<const Entry<Interface>*> chosen_entries(const Registry<Interface>& registry,
                                                    const std::vector<std::string>& names, const char* what,
                                                    const char* option) {
  std::vector<const Entry<Interface>*> chosen;
  if (names.empty())
    for (const auto& e : registry) chosen.push_back(&e);
  for (const std::string& name : names) {
    const auto* found = find_entry(registry, name);
    if (found == nullptr) {
      std::vector<std::string> all;
      std::string allowed;
      for (const auto& e : registry) {
        all.emplace_back(e.name);
        allowed += (allowed.empty() ? "" : ", ") + all.back();
      }
      const std::string near = nearest_word(name, all);
      throw InputError(fmt::format("command line: unknown {} '{}' in {}; allowed: {}; {}", what, name, option, allowed,
                                   near.empty() ? "use one of them" : "did you mean '" + near + "'?"));
    }
    bool there = false;
    for (const auto* e : chosen) there |= e == found;
    if (!there) chosen.push_back(found);
  }
  return chosen;
}

}  // namespace impinge
