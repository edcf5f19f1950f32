// One declaration a parameter. A row says where it is (dotted path), what it may be (kind, unit, range, names), what it
// starts as and what it means, and can read and write it. Scene file, --set, script, GUI, sweep and reference go by
// rows, but for the keys of bodies in a scene file, most of which have none: io/scene reads them. Rows of variables are
// declared through rows.hpp.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <variant>

#include "engine/core/types.hpp"

namespace impinge {

enum class ParameterKind { boolean, integer, real, text, choice, vector3, text_list };

using ParameterValue = std::variant<bool, std::int64_t, double, std::string, Vec3, std::vector<std::string>>;

/// Closed interval of what a number (or each component of a vector) may be. `logarithmic` is how a slider should move.
struct Range {
  double low = -1e15, high = 1e15;
  bool logarithmic = false;
};

struct Parameter {
  std::string path;
  ParameterKind kind = ParameterKind::real;
  std::string unit;  ///< "m", "s", "m/s²", "" for a number without one
  Range range;
  std::vector<std::string> names;  ///< of a choice
  std::string doc;                 ///< one sentence
  ParameterValue initial;
  std::function<ParameterValue()> get;
  std::function<void(const ParameterValue&)> set;  ///< null: fixed with the scene
  bool live = true;                                ///< may change between frames; else only before the first
  /// Of a real number that may be left open, to what stands above it or to the program: the word that says so, beside
  /// numbers; the value then is that word, as a text. "" where a number is a must.
  std::string word = {};
};

class ParameterSet {
 public:
  /// Throws InternalError on a path that exists. Rows of variables are made by rows.hpp.
  Parameter& add(Parameter parameter);
  /// A path under which a row stood in earlier versions; one that several rows had stands for each of them. What reads
  /// paths takes it (see renamed) and writes the present ones. Throws InternalError where it is a row's present path.
  void add_former_path(std::string former, std::string path);

  const Parameter* find(std::string_view path) const;
  /// The present paths of a former one, in the order in which they were given; null for any other.
  const std::vector<std::string>* renamed(std::string_view path) const;
  const std::map<std::string, std::vector<std::string>, std::less<>>& former_paths() const { return former_; }
  /// What to tell whoever used such paths, each once: which to write instead. "" for none.
  std::string note_of_former(const std::vector<std::string>& used) const;
  /// Takes away those that were declared last, all but the first `count`.
  void cut(std::size_t count);
  const std::deque<Parameter>& all() const { return rows_; }  ///< in order of declaration; they stay where they are
  /// The known path nearest to `path` (edit distance), or "" when none is near.
  std::string nearest(std::string_view path) const;
  /// "unknown parameter 'x'; did you mean 'y'?" and the like: what to say for a path that is not there.
  std::string unknown_message(std::string_view path) const;

 private:
  std::deque<Parameter> rows_;
  std::map<std::string, std::size_t, std::less<>> index_;
  std::map<std::string, std::vector<std::string>, std::less<>> former_;
};

/// The value a text stands for: `0.5`, `true`, `[0, -9.81, 0]` (or `0 -9.81 0`), a word, `[a, b]`. Throws InputError
/// (without a place: the caller knows it) naming what was found and what is allowed.
ParameterValue parse_value(const Parameter& row, std::string_view text);

/// Throws InputError if the value has another type or lies out of range; integers are taken for reals.
ParameterValue checked_value(const Parameter& row, ParameterValue value);

/// Without the blanks and line ends around it.
std::string_view trimmed(std::string_view text);

/// Shortest text that parse_value reads back exactly; vectors as `[x, y, z]`.
std::string format_value(const ParameterValue& value);

/// What is allowed, in words: "a real number in [0, 1e9] m/s", "one of a, b".
std::string describe_allowed(const Parameter& row);

/// The candidate nearest to `word` by edit distance, or "" when none is within a third of its length (at least 2).
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

/// The names as a list for a message: all of a few, the first of many and how many more there are.
std::string some_of(const std::vector<std::string>& names);

/// Shortest decimal text that reads back to the same double.
std::string shortest(double value);

}  // namespace impinge
