// Methods with settings, as tests want them.
#pragma once

#include <fmt/format.h>

#include <sstream>

#include "engine/core/error.hpp"
#include "engine/response/response.hpp"
#include "engine/world/world.hpp"

namespace impinge::test {

/// A parameter of the model, by its path and in the words of a scene.
inline void set(World& world, const std::string& path, const std::string& value) {
  ParameterSet rows;
  world.parameters.bind(rows);
  const Parameter* row = rows.find(path);
  if (row == nullptr) throw InternalError("no row " + path);
  row->set(parse_value(*row, value));
}
inline void set(World& world, const std::string& path, double value) { set(world, path, shortest(value)); }

/// "response:solver:tolerance", what is left out as it comes. Returns the words that follow.
inline std::istringstream choose(Parameters& parameters, const std::string& text) {
  std::istringstream words(text);
  std::string word;
  if (std::getline(words, word, ':')) parameters.response.method = word;
  if (std::getline(words, word, ':')) parameters.lcp.method = word;
  if (std::getline(words, word, ':')) parameters.lcp.tolerance = std::stod(word);
  return words;
}

/// What would be allowed in place of a text for choose() and one whole number more, called `more`; "" if nothing is wrong.
std::string method_fault(const std::string& text, const std::string& more);
/// The same for "path=value" with a parameter of the model.
std::string row_fault(const std::string& text);

/// Where a response has a limit of its own on iterations.
inline void allow_iterations(Response& response, int most) {
  const IterationSetting own = response.iteration_setting();
  if (own.count != nullptr && !own.is_exact) *own.count = most;
}
/// Of the response in use.
inline void allow_iterations(World& world, int most) { allow_iterations(*world.parameters.response.method, most); }

inline std::unique_ptr<Response> make_response(std::string_view name, const std::vector<RowText>& rows = {}) {
  auto response = make_named(responses(), name);
  configure(*response, rows);
  return response;
}
/// What makes a response do without another one's help, as a second method must.
inline std::vector<RowText> by_itself(std::string_view name) {
  if (name == "iterative_constraint_anticipation") return {{"factorizes", "false"}};
  return {};
}

/// A response with as many iterations of its own as it may need.
inline std::unique_ptr<Response> patient_response(std::string_view name, int most,
                                                  const std::vector<RowText>& rows = {}) {
  auto response = make_response(name, rows);
  allow_iterations(*response, most);
  return response;
}

}  // namespace impinge::test
