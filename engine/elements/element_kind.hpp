// The shape functions of a body's tetrahedra.
#pragma once

#include "engine/core/rows.hpp"

namespace impinge {

enum class ElementKind { linear, quadratic };

inline Words<ElementKind> element_words() {
  return {{ElementKind::linear, "linear"}, {ElementKind::quadratic, "quadratic"}};
}

}  // namespace impinge
