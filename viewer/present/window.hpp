// A window of the desktop: shows pixels and hands its input on. Nothing else knows a window system.
#pragma once

#include <memory>
#include <string>

#include "viewer/present/screen.hpp"

namespace impinge {

/// Whether there is a screen that a window can be opened on.
bool has_screen();

class Window : public Screen {
 public:
  /// Pixels. Throws InputError where no window can be had.
  Window(int width, int height, const std::string& title);
  ~Window() override;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  bool take_input(Ui& ui, int milliseconds) override;
  bool is_exposed() const override;
  void show(const Image& image) override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace impinge
