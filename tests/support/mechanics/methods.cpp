#include "tests/support/mechanics/methods.hpp"

#include "tests/support/program/bench_arguments.hpp"

namespace impinge::test {

std::string method_fault(const std::string& text, const std::string& more) {
  std::istringstream words(text);
  std::string word;
  std::string fault;
  if (!std::getline(words, word, ':') || !(fault = one_of(names_of(responses()))(word)).empty())
    return "a response: " + one_of(names_of(responses()))("");
  if (std::getline(words, word, ':') && !(fault = one_of(names_of(lcp_solvers()))(word)).empty())
    return "a cone solver second: " + fault;
  if (std::getline(words, word, ':') && !(fault = number_fault(word)).empty()) return "a tolerance third: " + fault;
  if (std::getline(words, word, ':') && !(fault = whole_number_fault(word)).empty()) return more + " fourth: " + fault;
  return std::getline(words, word, ':') ? "nothing after " + more : "";
}

std::string row_fault(const std::string& text) {
  const std::size_t is = text.find('=');
  if (is == std::string::npos) return "path=value";
  World world;
  ParameterSet rows;
  world.parameters.bind(rows);
  const Parameter* row = rows.find(text.substr(0, is));
  if (row == nullptr) return "a path that there is; " + rows.unknown_message(text.substr(0, is));
  try {
    row->set(parse_value(*row, text.substr(is + 1)));
  } catch (const std::exception& e) {
    return std::string("a value after '=': ") + e.what();
  }
  return "";
}

}  // namespace impinge::test
