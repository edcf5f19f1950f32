// From the text of an expression to its steps, by the grammar in expression.hpp.
#pragma once

#include "viewer/controller/expression.hpp"

namespace impinge {

/// Throws InputError at the first word that is wrong.
void parse_expression(const PlacedText& text, const ExpressionWords& words, std::vector<Expression::Step>& steps,
                      std::vector<BodyTerm>& terms);

}  // namespace impinge
