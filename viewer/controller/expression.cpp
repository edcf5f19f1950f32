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

/// Of a comparison, else null.
const char* sign_of(Operation operation) {
  switch (operation) {
    case Operation::less:
      return "<";
    case Operation::less_equal:
      return "<=";
    case Operation::greater:
      return ">";
    case Operation::greater_equal:
      return ">=";
    case Operation::equal:
      return "==";
    case Operation::unequal:
      return "!=";
    default:
      return nullptr;
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

std::optional<bool> Expression::truth(std::span<const double> values, std::string& why) const {
  // three truths: not a number is the one that nobody knows
  std::vector<double> stack;
  for (const Step& step : steps_) {
    if (step.operation == Operation::number || step.operation == Operation::name) {
      stack.push_back(step.operation == Operation::number ? step.number : values[step.name]);
      continue;
    }
    if (step.operation == Operation::negate || step.operation == Operation::absolute ||
        step.operation == Operation::logical_not) {
      double& x = stack.back();
      if (step.operation == Operation::logical_not)
        x = std::isnan(x) ? x : x == 0.0;
      else
        x = step.operation == Operation::negate ? -x : std::abs(x);
      continue;
    }
    const double r = stack.back();
    stack.pop_back();
    double& l = stack.back();
    if (step.operation == Operation::logical_and || step.operation == Operation::logical_or) {
      const double decides = step.operation == Operation::logical_or ? 1.0 : 0.0;
      l = l == decides || r == decides ? decides : std::isnan(l) || std::isnan(r) ? NAN : 1.0 - decides;
    } else if (const char* sign = sign_of(step.operation); sign != nullptr && !(std::isfinite(l) && std::isfinite(r))) {
      const bool is_left = !std::isfinite(l);
      const double odd = is_left ? l : r;
      if (why.empty())
        why = fmt::format("{} stands {} of '{}'",
                          std::isnan(odd) ? "not a number"
                          : odd > 0.0     ? "inf"
                                          : "-inf",
                          is_left ? "left" : "right", sign);
      l = NAN;
    } else {
      l = apply(step.operation, l, r);
    }
  }
  return std::isnan(stack.back()) ? std::nullopt : std::optional(stack.back() != 0.0);
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
