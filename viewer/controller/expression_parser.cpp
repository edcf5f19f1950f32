#include "viewer/controller/expression_parser.hpp"

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
  Parser(const PlacedText& text, const ExpressionWords& words, std::vector<Step>& steps, std::vector<BodyTerm>& terms)
      : text_(text), words_(words), names_(words.names), steps_(steps), terms_(terms) {}

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
  /// The function whose call stands here, or null; `at_` is then behind its parenthesis.
  const BodyFigure* take_function() {
    if (words_.bodies.empty()) return nullptr;
    std::size_t end = at_;
    while (end < text_.text.size() && is_word(text_.text[end])) ++end;
    const std::string name(text_.text.substr(at_, end - at_));
    std::size_t open = end;
    while (open < text_.text.size() && (text_.text[open] == ' ' || text_.text[open] == '\t')) ++open;
    if (open == text_.text.size() || text_.text[open] != '(') return nullptr;
    std::vector<std::string> known = {"abs"};
    for (const BodyFigure& figure : body_figures()) {
      if (!figure.in_conditions()) continue;
      if (figure.name == name) {
        at_ = open + 1;
        return &figure;
      }
      known.emplace_back(figure.name);
    }
    const std::string near = nearest_word(name, known);
    text_.part(at_, end - at_)
        .refuse(fmt::format("unknown function '{}'", name),
                fmt::format("allowed: abs(NUMBER), {}", fmt::join(body_functions(), ", ")),
                near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
  }
  int read_body() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.text.size() && (is_word(text_.text[at_]) || text_.text[at_] == '-')) ++at_;
    const std::string name(text_.text.substr(begin, at_ - begin));
    const auto it = std::find(words_.bodies.begin(), words_.bodies.end(), name);
    if (it == words_.bodies.end()) {
      constexpr std::size_t kListed = 12;
      const std::size_t all = words_.bodies.size();
      const std::vector<std::string> listed(
          words_.bodies.begin(), words_.bodies.begin() + static_cast<std::ptrdiff_t>(std::min(all, kListed)));
      const std::string near = nearest_word(name, words_.bodies);
      text_.part(begin, at_ - begin)
          .refuse(name.empty() ? found() + " instead of a body" : fmt::format("unknown body '{}'", name),
                  fmt::format("bodies: {}{}", fmt::join(listed, ", "),
                              all > kListed ? fmt::format(" and {} more", all - kListed) : ""),
                  near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
    }
    return static_cast<int>(it - words_.bodies.begin());
  }
  LedgerSource read_source() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.text.size() && is_word(text_.text[at_])) ++at_;
    const std::string name(text_.text.substr(begin, at_ - begin));
    if (const std::optional<LedgerSource> source = find_ledger_source(name)) return *source;
    std::vector<std::string> known;
    for (const LedgerSourceInfo& info : ledger_sources()) known.emplace_back(info.name);
    const std::string near = nearest_word(name, known);
    text_.part(begin, at_ - begin)
        .refuse(name.empty() ? found() + " instead of a source" : fmt::format("unknown source '{}'", name),
                fmt::format("sources of the ledger: {}", fmt::join(known, ", ")),
                near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
  }
  Type read_call(const BodyFigure& function) {
    BodyTerm term;
    term.function = function.function;
    if (function.function == BodyFunction::energy_from) {
      term.source = read_source();
      term.text = fmt::format("{}({}", function.name, info_of(term.source).name);
      term.a = take(",") ? read_body() : -1;
      if (term.a >= 0) term.text += fmt::format(",{}", words_.bodies[static_cast<std::size_t>(term.a)]);
    } else {
      term.a = read_body();
      term.text = fmt::format("{}({}", function.name, words_.bodies[static_cast<std::size_t>(term.a)]);
    }
    if (function.bodies == 2) {
      if (!take(",")) here().refuse(found(), fmt::format("{} asks of two bodies", function.name), "name another one");
      skip_blanks();
      const std::size_t begin = at_;
      term.b = read_body();
      const auto second = static_cast<std::size_t>(term.b);
      if (term.b == term.a && second < words_.may_meet_itself.size() && !words_.may_meet_itself[second])
        text_.part(begin, at_ - begin)
            .refuse(fmt::format("'{}' a second time", words_.bodies[second]),
                    fmt::format("{} asks of two bodies, and only one that deforms may touch itself", function.name),
                    "name another one");
      term.text += fmt::format(",{}", words_.bodies[static_cast<std::size_t>(term.b)]);
    }
    term.text += ")";
    if (!take(")"))
      here().refuse(found(),
                    fmt::format("')' should stand here: {} asks of {}", function.name,
                                function.bodies == 2 ? "two bodies" : "one body"),
                    "close the parenthesis");
    const auto known =
        std::find_if(terms_.begin(), terms_.end(), [&](const BodyTerm& t) { return t.text == term.text; });
    Step step{Operation::name};
    step.name = static_cast<int>(names_.size()) + static_cast<int>(known - terms_.begin());
    if (known == terms_.end()) terms_.push_back(std::move(term));
    steps_.push_back(step);
    return Type::number;
  }
  /// Whether `abs` and its parenthesis stand here; a figure of that name comes first.
  bool take_absolute() {
    if (text_.text.substr(at_, 3) != "abs" || std::find(names_.begin(), names_.end(), "abs") != names_.end())
      return false;
    const std::size_t begin = at_;
    at_ += 3;
    if (take("(")) return true;
    at_ = begin;
    return false;
  }
  Type read_absolute() {
    deepen();
    skip_blanks();
    const PlacedText inner = here();
    want(read_sum(), Type::number, inner);
    --depth_;
    if (!take(")")) here().refuse(found(), "')' should stand here: abs takes one number", "close the parenthesis");
    emit(Operation::absolute);
    return Type::number;
  }
  Type read_name() {
    if (take_absolute()) return read_absolute();
    if (const BodyFigure* function = take_function()) return read_call(*function);
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
      if (!words_.bodies.empty()) all.insert(all.end(), body_functions().begin(), body_functions().end());
      const std::string near = nearest_word(name, all);
      // as parameters are written, which are what a body is given and not where it is
      const bool is_path = !words_.bodies.empty() && name.starts_with("body.");
      text_.part(begin, at_ - begin)
          .refuse(fmt::format("unknown figure '{}'", name),
                  words_.allowed.empty() ? fmt::format("allowed: {}", fmt::join(all, ", ")) : words_.allowed,
                  is_path        ? "ask of a body by a call: position_y(A), velocity_y(A), speed(A)"
                  : near.empty() ? "use one of them"
                                 : fmt::format("did you mean '{}'?", near));
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
  std::vector<BodyTerm>& terms_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

const std::vector<std::string>& body_functions() {
  static const std::vector<std::string> list = [] {
    std::vector<std::string> calls;
    for (const BodyFigure& figure : body_figures())
      if (figure.in_conditions()) calls.push_back(fmt::format("{}({})", figure.name, figure.arguments()));
    return calls;
  }();
  return list;
}

void parse_expression(const PlacedText& text, const ExpressionWords& words, std::vector<Expression::Step>& steps,
                      std::vector<BodyTerm>& terms) {
  Parser(text, words, steps, terms).parse();
}

}  // namespace impinge
