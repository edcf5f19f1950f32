#include "viewer/controller/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/parameter.hpp"
#include "viewer/controller/expression_parser.hpp"

namespace impinge {

namespace {

using Operation = Expression::Operation;
using Step = Expression::Step;

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
  parse_expression(text, words, steps_, terms_);
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
    } else if (step.operation == Operation::absolute) {
      stack.back() = std::abs(stack.back());
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
    const auto place = static_cast<std::size_t>(step.name);
    const std::string& name = place < names.size() ? names[place] : terms_[place - names.size()].text;
    const std::string part = fmt::format("{} = {}", name, shortest(values[place]));
    if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(part);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace impinge
