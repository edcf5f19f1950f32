// Conditions over named figures: `max_penetration_m > 1e-3 && contacts >= 2 * groups`.
//
//   or      = and { "||" and }          compare = sum [ ( < <= > >= == != ) sum ]
//   and     = not { "&&" not }          sum     = product { ( + - ) product }
//   not     = "!" not | compare         product = unary { ( * / ) unary }
//                                       unary   = "-" unary | number | name | call | text | "(" or ")"
//                                                | "abs" "(" sum ")"
//                                       call    = function "(" body { "," body } ")"
//
// A name may hold dots and be a function of one word, `max(contacts)`; a text, bare or in quotes, is compared by == and
// !=. Calls speak of bodies where there are any: `depth(crate, floor) > 1e-3`.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/ledger/frame_ledger.hpp"
#include "viewer/controller/text_place.hpp"
#include "viewer/state/body_figures.hpp"

namespace impinge {

/// What is asked of one or two bodies.
struct BodyTerm {
  BodyFunction function = BodyFunction::contacts;
  int a = 0, b = 0;  ///< places in ExpressionWords::bodies; b of a function of two; of energy_from: a is -1 for all
  LedgerSource source = LedgerSource::gravity;  ///< of energy_from
  std::string text;                             ///< "depth(crate,floor)"
};
/// "contacts(A,B)" and so on, for messages and help.
const std::vector<std::string>& body_functions();

/// What an expression may speak of, when that is more than figures.
struct ExpressionWords {
  std::vector<std::string> names;        ///< by position in `values`; "f(x)" is written as a call
  std::vector<bool> is_text;             ///< by name: its value is a position in `texts`; may be shorter than `names`
  std::vector<std::string> texts;        ///< all that such names may be
  std::string allowed;                   ///< for messages, instead of all names
  bool takes_number = false;             ///< whether the whole may be a number too
  std::vector<std::string> bodies = {};  ///< that calls may name; none: there are no calls
  /// By body, whether a call of two may name it twice: of a rigid body that says nothing. None: every body.
  std::vector<bool> may_meet_itself = {};
};

class Expression {
 public:
  Expression(const PlacedText& text, const ExpressionWords& words);
  /// `names` are the figures there are, by position in `values` below. Throws InputError at the first word that is
  /// wrong.
  Expression(const PlacedText& text, const std::vector<std::string>& names);

  /// What it asks of bodies: their values follow those of the names.
  const std::vector<BodyTerm>& terms() const { return terms_; }
  /// Truth is 1, falsehood 0. Comparisons with NaN are false.
  double evaluate(std::span<const double> values) const;
  bool holds(std::span<const double> values) const { return evaluate(values) != 0.0; }
  /// Whether it can be said to hold, or not to: nothing where that hangs on a comparison with a value that is not finite,
  /// whichever way that comparison goes. `why`: the first of these, "inf stands left of '>'".
  std::optional<bool> truth(std::span<const double> values, std::string& why) const;
  const std::string& text() const { return text_; }
  bool uses(std::size_t name) const;  ///< whether that name stands in it
  /// The named figures with their values, "contacts = 12, groups = 3": for messages.
  std::string describe(std::span<const double> values, const std::vector<std::string>& names) const;

  enum class Operation {
    number,
    name,
    negate,
    absolute,
    logical_not,
    add,
    subtract,
    multiply,
    divide,
    less,
    less_equal,
    greater,
    greater_equal,
    equal,
    unequal,
    logical_and,
    logical_or
  };
  struct Step {
    Operation operation;
    double number = 0.0;  ///< of a number
    int name = -1;        ///< position of a name, or, behind the last one, of a term
  };

 private:
  std::string text_;
  std::vector<Step> steps_;  // postfix order
  std::vector<BodyTerm> terms_;
};

}  // namespace impinge
