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

enum class Type { number, condition, text };
constexpr const char* kTypeNames[] = {"a number", "a condition", "a text"};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; }

// descends the grammar of the header; each function says what it read
class Parser {
 public:
  Parser(const PlacedText& text, const ExpressionWords& words, std::vector<Step>& steps)
      : text_(text), words_(words), names_(words.names), steps_(steps) {}

  void parse() {
    const Type type = read_or();
    skip_blanks();
    if (at_ < text_.text.size())
      here().refuse(found(), "an operator or the end of the condition should stand here", "mend the condition");
    if (type == Type::condition || (type == Type::number && words_.takes_number)) return;
    text_.refuse(fmt::format("'{}' is {}", text_.text, kTypeNames[static_cast<int>(type)]),
                 words_.takes_number ? "a number is wanted" : "a condition is wanted",
                 type == Type::text ? "compare it: == !=" : "compare it: < <= > >= == !=");
  }

 private:
  void skip_blanks() {
    while (at_ < text_.text.size() && (text_.text[at_] == ' ' || text_.text[at_] == '\t')) ++at_;
  }
  PlacedText here() const { return text_.part(std::min(at_, text_.text.size())); }
  std::string found() const {
    return at_ < text_.text.size() ? fmt::format("'{}'", text_.text.substr(at_, 12)) : "the end of the condition";
  }
  bool take(std::string_view symbol) {
    skip_blanks();
    if (text_.text.substr(std::min(at_, text_.text.size()), symbol.size()) != symbol) return false;
    at_ += symbol.size();
    return true;
  }
  void emit(Operation operation) { steps_.push_back({operation}); }
  void want(Type is, Type wanted, const PlacedText& where) const {
    if (is != wanted)
      where.refuse(kTypeNames[static_cast<int>(is)],
                   fmt::format("{} should stand here", kTypeNames[static_cast<int>(wanted)]),
                   "use parentheses or a comparison");
  }

  Type read_or() {
    const PlacedText start = here();
    Type type = read_and();
    while (take("||")) {
      want(type, Type::condition, start);
      want(read_and(), Type::condition, start);
      emit(Operation::logical_or);
    }
    return type;
  }
  Type read_and() {
    const PlacedText start = here();
    Type type = read_not();
    while (take("&&")) {
      want(type, Type::condition, start);
      want(read_not(), Type::condition, start);
      emit(Operation::logical_and);
    }
    return type;
  }
  Type read_not() {
    skip_blanks();
    const bool negation = at_ < text_.text.size() && text_.text[at_] == '!' && text_.text.substr(at_, 2) != "!=";
    if (!negation) return read_compare();
    const PlacedText start = here();
    ++at_;
    deepen();
    want(read_not(), Type::condition, start);
    --depth_;
    emit(Operation::logical_not);
    return Type::condition;
  }
  Type read_compare() {
    const PlacedText start = here();
    const Type type = read_sum();
    constexpr std::pair<std::string_view, Operation> kOperators[] = {
        {"<=", Operation::less_equal}, {">=", Operation::greater_equal}, {"==", Operation::equal},
        {"!=", Operation::unequal},    {"<", Operation::less},           {">", Operation::greater}};
    for (const auto& [symbol, operation] : kOperators) {
      if (!take(symbol)) continue;
      const bool is_text = type == Type::text && (operation == Operation::equal || operation == Operation::unequal);
      if (!is_text) want(type, Type::number, start);
      skip_blanks();
      const PlacedText right = here();
      want(read_sum(), type, right);
      emit(operation);
      return Type::condition;
    }
    return type;
  }
  Type read_sum() {
    const PlacedText start = here();
    const Type type = read_product();
    for (;;) {
      const Operation operation = take("+") ? Operation::add : take("-") ? Operation::subtract : Operation::number;
      if (operation == Operation::number) return type;
      want(type, Type::number, start);
      want(read_product(), Type::number, start);
      emit(operation);
    }
  }
  Type read_product() {
    const PlacedText start = here();
    const Type type = read_unary();
    for (;;) {
      const Operation operation = take("*") ? Operation::multiply : take("/") ? Operation::divide : Operation::number;
      if (operation == Operation::number) return type;
      want(type, Type::number, start);
      want(read_unary(), Type::number, start);
      emit(operation);
    }
  }
  Type read_unary() {
    skip_blanks();
    const PlacedText start = here();
    if (take("-")) {
      deepen();
      want(read_unary(), Type::number, start);
      --depth_;
      emit(Operation::negate);
      return Type::number;
    }
    if (take("(")) {
      deepen();
      const Type type = read_or();
      --depth_;
      if (!take(")")) here().refuse(found(), "')' should stand here", "close the parenthesis");
      return type;
    }
    const char c = at_ < text_.text.size() ? text_.text[at_] : '\0';
    if ((c >= '0' && c <= '9') || c == '.') return read_number();
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_') return read_name();
    if ((c == '"' || c == '\'') && !words_.texts.empty()) return read_quoted(c);
    here().refuse(found(), "a number, a figure's name or '(' should stand here", "mend the condition");
  }
  Type read_number() {
    Step step{Operation::number};
    const char* begin = text_.text.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.text.data() + text_.text.size(), step.number);
    if (error != std::errc()) here().refuse(found(), "a number that a double holds is wanted", "change it");
    at_ += static_cast<std::size_t>(end - begin);
    steps_.push_back(step);
    return Type::number;
  }
  // the longest name that stands here: body names may hold a minus
  std::size_t longest_name() const {
    std::size_t longest = 0;
    for (const std::string& name : names_)
      if (name.size() > longest && text_.text.substr(at_, name.size()) == name &&
          (at_ + name.size() == text_.text.size() || !is_word(text_.text[at_ + name.size()])))
        longest = name.size();
    return longest;
  }
  Type read_name() {
    const std::size_t begin = at_;
    if (const std::size_t longest = longest_name(); longest > 0)
      at_ += longest;
    else
      while (at_ < text_.text.size() && is_word(text_.text[at_])) ++at_;
    std::string name(text_.text.substr(begin, at_ - begin));
    if (std::any_of(names_.begin(), names_.end(), [&](const std::string& n) { return n.rfind(name + "(", 0) == 0; }) &&
        take("(")) {
      skip_blanks();
      const std::size_t inner = at_;
      while (at_ < text_.text.size() && is_word(text_.text[at_])) ++at_;
      name += "(" + std::string(text_.text.substr(inner, at_ - inner)) + ")";
      if (!take(")")) here().refuse(found(), "')' should stand here", "close the parenthesis");
    }
    const auto it = std::find(names_.begin(), names_.end(), name);
    if (it == names_.end()) {
      if (std::find(words_.texts.begin(), words_.texts.end(), name) != words_.texts.end()) return emit_text(name);
      std::vector<std::string> all = names_;
      all.insert(all.end(), words_.texts.begin(), words_.texts.end());
      const std::string near = nearest_word(name, all);
      text_.part(begin, at_ - begin)
          .refuse(fmt::format("unknown figure '{}'", name),
                  words_.allowed.empty() ? fmt::format("allowed: {}", fmt::join(names_, ", ")) : words_.allowed,
                  near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
    }
    Step step{Operation::name};
    step.name = static_cast<int>(it - names_.begin());
    steps_.push_back(step);
    return static_cast<std::size_t>(step.name) < words_.is_text.size() && words_.is_text[step.name] ? Type::text
                                                                                                    : Type::number;
  }
  Type read_quoted(char quote) {
    const std::size_t begin = at_++;
    const std::size_t end = text_.text.find(quote, at_);
    if (end == std::string_view::npos)
      text_.part(begin).refuse("a text without end", "a quote should close it", "close it");
    const std::string text(text_.text.substr(at_, end - at_));
    at_ = end + 1;
    if (std::find(words_.texts.begin(), words_.texts.end(), text) == words_.texts.end()) {
      const std::string near = nearest_word(text, words_.texts);
      text_.part(begin).refuse(fmt::format("'{}', which nothing here is", text),
                               fmt::format("allowed: {}", fmt::join(words_.texts, ", ")),
                               near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
    }
    return emit_text(text);
  }
  Type emit_text(const std::string& text) {
    Step step{Operation::number};
    step.number = static_cast<double>(std::find(words_.texts.begin(), words_.texts.end(), text) - words_.texts.begin());
    steps_.push_back(step);
    return Type::text;
  }
  void deepen() {
    if (++depth_ > kMostDepth) here().refuse("nesting deeper than 64", "flatter conditions are wanted", "unfold it");
  }

  PlacedText text_;
  const ExpressionWords& words_;
  const std::vector<std::string>& names_;
  std::vector<Step>& steps_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

double apply(Operation operation, double l, double r) {
  switch (operation) {
    case Operation::add:
      return l + r;
    case Operation::subtract:
      return l - r;
    case Operation::multiply:
      return l * r;
    case Operation::divide:
      return l / r;
    case Operation::less:
      return l < r;
    case Operation::less_equal:
      return l <= r;
    case Operation::greater:
      return l > r;
    case Operation::greater_equal:
      return l >= r;
    case Operation::equal:
      return l == r;
    case Operation::unequal:
      return l < r || l > r;  // false for NaN, like the others
    case Operation::logical_and:
      return l != 0.0 && r != 0.0;
    case Operation::logical_or:
      return l != 0.0 || r != 0.0;
    default:
      return 0.0;
  }
}

}  // namespace

Expression::Expression(const PlacedText& text, const ExpressionWords& words) : text_(text.text) {
  Parser(text, words, steps_).parse();
}

Expression::Expression(const PlacedText& text, const std::vector<std::string>& names)
    : Expression(text, ExpressionWords{names, {}, {}, "", false}) {}

bool Expression::uses(std::size_t name) const {
  return std::any_of(steps_.begin(), steps_.end(), [&](const Step& step) {
    return step.operation == Operation::name && step.name == static_cast<int>(name);
  });
}

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
