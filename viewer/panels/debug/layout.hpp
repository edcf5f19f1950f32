// Where everything is in the debugger's window: columns left and right, a strip below, the view between them. Nothing
// overlaps.
#pragma once

#include "viewer/panels/debug/panel.hpp"

namespace impinge {

struct DebugLayout {
  UiArea view;
  std::vector<UiArea> panels;  ///< as panels() has them
  /// Of the panel of that name. Throws InternalError if there is none.
  const UiArea& area(std::string_view panel) const;
};
DebugLayout debug_layout(int width, int height, float unit);
/// The smallest window that the panels have room in, for unit 1.
constexpr int kLeastWidth = 800, kLeastHeight = 500;

/// Whole-number text scale for a window of that height.
int debug_scale(int height);

}  // namespace impinge
