// The command line of a benchmark, read wholly before anything runs: an argument that it doesn't know must not cost hours.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace impinge::test {

template <class Number>
struct Limits {
  Number least = std::numeric_limits<Number>::lowest(), most = std::numeric_limits<Number>::max();
};

/// Declared in the order in which they are given; those whose names begin with "--" are options, given anywhere and followed
/// by their value. Each is declared with what holds its default, which what is read overwrites; where that is empty, `about`
/// says what it means.
class BenchArguments {
 public:
  /// What would be allowed in place of this word; "" if nothing is wrong with it.
  using Check = std::function<std::string(const std::string&)>;

  BenchArguments(std::string program, std::string measures);

  void number(const std::string& name, int& value, Limits<int> limits, const std::string& about);
  void number(const std::string& name, double& value, Limits<double> limits, const std::string& about);
  void word(const std::string& name, std::string& value, const Check& check, const std::string& about);
  /// All that are left. The first that is given takes the default's place.
  void words(const std::string& name, std::vector<std::string>& values, const Check& check, const std::string& about);

  struct Ending {
    int code = 0;
    std::string text;  ///< for stdout, or for stderr if the code isn't 0
  };
  /// Nothing: all are read, go on.
  std::optional<Ending> read(const std::vector<std::string>& words) const;
  /// Prints it and ends the program where there is nothing to run.
  void read_or_exit(int argc, char** argv) const;
  std::string help() const;

 private:
  struct Argument {
    std::string name, about, unless_given;
    std::function<std::string(const std::string&)> take;  ///< as Check, and keeps the value if nothing is wrong
    bool is_last = false;                                 ///< takes all words that are left
    bool is_option() const { return name.starts_with("--"); }
  };
  std::string usage() const;
  Ending refusal(const std::string& what) const;

  std::string program_, measures_;
  std::vector<Argument> arguments_;
};

/// Checks: one of these; a file that is there.
BenchArguments::Check one_of(const std::vector<std::string>& words);
std::string file_fault(const std::string& path);
/// A number and nothing else: what would be allowed in its place, or "".
std::string number_fault(const std::string& word);
std::string whole_number_fault(const std::string& word);

/// The names of a registry, for one_of.
template <class Registry>
std::vector<std::string> names_of(const Registry& registry) {
  std::vector<std::string> names;
  for (const auto& entry : registry) names.emplace_back(entry.name);
  return names;
}

}  // namespace impinge::test
