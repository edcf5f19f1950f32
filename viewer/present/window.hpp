// A window of the desktop: shows pixels and hands its input on. Nothing else knows a window system.
#pragma once

#include <memory>
#include <string>

#include "viewer/image/image.hpp"
#include "viewer/panels/debug/ui.hpp"

namespace impinge {

/// Whether there is a screen that a window can be opened on.
bool has_screen();

class Window {
 public:
  /// Pixels. Throws InputError where no window can be had.
  Window(int width, int height, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Puts the input since the last call into the queue; where there is none, waits for some at most `milliseconds`.
  /// False once the window is closed.
  bool take_input(Ui& ui, int milliseconds);
  /// Whether the desktop may have lost what was shown.
  bool is_exposed() const;
  void show(const Image& image);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace impinge
