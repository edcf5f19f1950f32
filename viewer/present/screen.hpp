// What shows the debugger's pixels and hands on what its user does: a window of the desktop, browsers elsewhere.
#pragma once

#include "viewer/image/image.hpp"
#include "viewer/panels/debug/ui.hpp"

namespace impinge {

class Screen {
 public:
  virtual ~Screen() = default;
  /// Puts the input since the last call into the queue; where there is none, waits for some at most `milliseconds`.
  /// False once its user has closed it.
  virtual bool take_input(Ui& ui, int milliseconds) = 0;
  /// Whether what was shown may be lost.
  virtual bool is_exposed() const = 0;
  virtual void show(const Image& image) = 0;
};

}  // namespace impinge
