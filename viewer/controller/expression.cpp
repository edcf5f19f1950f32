#include "viewer/controller/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/parameter.hpp"

namespace impinge {

namespace {

using Operation = Expression::Operation;
using Step = Expression::Step;
constexpr int kMostDepth = 64;

// descends the grammar of the header; each function says whether what it read is a condition
class Parser {
 public:
  Parser(const PlacedText& text, const std::vector<std::string>& names, std::vector<Step>& steps) : text_(text), names_(names), steps_(steps) {}

  void parse() {
    const bool condition = read_or();
    skip_blanks();
    if (at_ < text_.text.size()) here().refuse(found(), "an operator or the end of the condition should stand here", "mend the condition");
    if (!condition) text_.refuse(fmt::format("'{}' is a number", text_.text), "a condition is wanted", "compare it: < <= > >= == !=");
  }

 private:
  void skip_blanks() {
    while (at_ < text_.text.size() && (text_.text[at_] == ' ' || text_.text[at_] == '\t')) ++at_;
  }
  PlacedText here() const { return text_.part(std::min(at_, text_.text.size())); }
  std::string found() const { return at_ < text_.text.size() ? fmt::format("'{}'", text_.text.substr(at_, 12)) : "the end of the condition"; }
  bool take(std::string_view symbol) {
    skip_blanks();
    if (text_.text.substr(std::min(at_, text_.text.size()), symbol.size()) != symbol) return false;
    at_ += symbol.size();
    return true;
  }
  void emit(Operation operation) { steps_.push_back({operation}); }
  void want(bool is, bool wanted, const PlacedText& where) const {
    if (is != wanted) where.refuse(is ? "a condition" : "a number", wanted ? "a condition should stand here" : "a number should stand here", "use parentheses or a comparison");
  }

  bool read_or() {
    const PlacedText start = here();
    bool condition = read_and();
    while (take("||")) {
      want(condition, true, start);
      want(read_and(), true, start);
      emit(Operation::logical_or);
    }
    return condition;
  }
  bool read_and() {
    const PlacedText start = here();
    bool condition = read_not();
    while (take("&&")) {
      want(condition, true, start);
      want(read_not(), true, start);
      emit(Operation::logical_and);
    }
    return condition;
  }
  bool read_not() {
    skip_blanks();
    const bool negation = at_ < text_.text.size() && text_.text[at_] == '!' && text_.text.substr(at_, 2) != "!=";
    if (!negation) return read_compare();
    const PlacedText start = here();
    ++at_;
    deepen();
    want(read_not(), true, start);
    --depth_;
    emit(Operation::logical_not);
    return true;
  }
  bool read_compare() {
    const PlacedText start = here();
    const bool condition = read_sum();
    constexpr std::pair<std::string_view, Operation> kOperators[] = {{"<=", Operation::less_equal}, {">=", Operation::greater_equal}, {"==", Operation::equal},
                                                                     {"!=", Operation::unequal},    {"<", Operation::less},           {">", Operation::greater}};
    for (const auto& [symbol, operation] : kOperators) {
      if (!take(symbol)) continue;
      want(condition, false, start);
      want(read_sum(), false, start);
      emit(operation);
      return true;
    }
    return condition;
  }
  bool read_sum() {
    const PlacedText start = here();
    const bool condition = read_product();
    for (;;) {
      const Operation operation = take("+") ? Operation::add : take("-") ? Operation::subtract : Operation::number;
      if (operation == Operation::number) return condition;
      want(condition, false, start);
      want(read_product(), false, start);
      emit(operation);
    }
  }
  bool read_product() {
    const PlacedText start = here();
    const bool condition = read_unary();
    for (;;) {
      const Operation operation = take("*") ? Operation::multiply : take("/") ? Operation::divide : Operation::number;
      if (operation == Operation::number) return condition;
      want(condition, false, start);
      want(read_unary(), false, start);
      emit(operation);
    }
  }
  bool read_unary() {
    skip_blanks();
    const PlacedText start = here();
    if (take("-")) {
      deepen();
      want(read_unary(), false, start);
      --depth_;
      emit(Operation::negate);
      return false;
    }
    if (take("(")) {
      deepen();
      const bool condition = read_or();
      --depth_;
      if (!take(")")) here().refuse(found(), "')' should stand here", "close the parenthesis");
      return condition;
    }
    const char c = at_ < text_.text.size() ? text_.text[at_] : '\0';
    if ((c >= '0' && c <= '9') || c == '.') read_number();
    else if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_') read_name();
    else here().refuse(found(), "a number, a figure's name or '(' should stand here", "mend the condition");
    return false;
  }
  void read_number() {
    Step step{Operation::number};
    const char* begin = text_.text.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.text.data() + text_.text.size(), step.number);
    if (error != std::errc()) here().refuse(found(), "a number that a double holds is wanted", "change it");
    at_ += static_cast<std::size_t>(end - begin);
    steps_.push_back(step);
  }
  void read_name() {
    const std::size_t begin = at_;
    while (at_ < text_.text.size() && (std::isalnum(static_cast<unsigned char>(text_.text[at_])) || text_.text[at_] == '_')) ++at_;
    const std::string name(text_.text.substr(begin, at_ - begin));
    const auto it = std::find(names_.begin(), names_.end(), name);
    if (it == names_.end()) {
      const std::string near = nearest_word(name, names_);
      text_.part(begin, name.size()).refuse(fmt::format("unknown figure '{}'", name), fmt::format("allowed: {}", fmt::join(names_, ", ")),
                                            near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
    }
    Step step{Operation::name};
    step.name = static_cast<int>(it - names_.begin());
    steps_.push_back(step);
  }
  void deepen() {
    if (++depth_ > kMostDepth) here().refuse("nesting deeper than 64", "flatter conditions are wanted", "unfold it");
  }

  PlacedText text_;
  const std::vector<std::string>& names_;
  std::vector<Step>& steps_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

double apply(Operation operation, double l, double r) {
  switch (operation) {
    case Operation::add: return l + r;
    case Operation::subtract: return l - r;
    case Operation::multiply: return l * r;
    case Operation::divide: return l / r;
    case Operation::less: return l < r;
    case Operation::less_equal: return l <= r;
    case Operation::greater: return l > r;
    case Operation::greater_equal: return l >= r;
    case Operation::equal: return l == r;
    case Operation::unequal: return l < r || l > r;  // false for NaN, like the others
    case Operation::logical_and: return l != 0.0 && r != 0.0;
    case Operation::logical_or: return l != 0.0 || r != 0.0;
    default: return 0.0;
  }
}

}  // namespace

Expression::Expression(const PlacedText& text, const std::vector<std::string>& names) : text_(text.text) { Parser(text, names, steps_).parse(); }

double Expression::evaluate(std::span<const double> values) const {
  std::vector<double> stack;
  for (const Step& step : steps_) {
    if (step.operation == Operation::number) {
      stack.push_back(step.number);
    } else if (step.operation == Operation::name) {
      stack.push_back(values[step.name]);
    } else if (step.operation == Operation::negate) {
      stack.back() = -stack.back();
    } else if (step.operation == Operation::logical_not) {
      stack.back() = stack.back() == 0.0;
    } else {
      const double r = stack.back();
      stack.pop_back();
      stack.back() = apply(step.operation, stack.back(), r);
    }
  }
  return stack.back();
}

std::string Expression::describe(std::span<const double> values, const std::vector<std::string>& names) const {
  std::vector<std::string> parts;
  for (const Step& step : steps_) {
    if (step.operation != Operation::name) continue;
    const std::string part = fmt::format("{} = {}", names[step.name], shortest(values[step.name]));
    if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(part);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace impinge
