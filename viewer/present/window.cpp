// SDL's own ways to OpenGL and OSMesa in one process crash (both bring a dispatch table), so the window is drawn by
// SDL's software renderer: a streaming texture that gets the pixels.
#include "viewer/present/window.hpp"

#include <SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

[[noreturn]] void refuse(const std::string& found) {
  throw InputError(fmt::format("window: {}; a screen is wanted; set DISPLAY, or use --headless with --script", found));
}

int key_code(SDL_Keycode key) {
  static const std::pair<SDL_Keycode, const char*> kKeys[] = {{SDLK_TAB, "tab"},
                                                              {SDLK_LEFT, "left"},
                                                              {SDLK_RIGHT, "right"},
                                                              {SDLK_UP, "up"},
                                                              {SDLK_DOWN, "down"},
                                                              {SDLK_HOME, "home"},
                                                              {SDLK_END, "end"},
                                                              {SDLK_DELETE, "delete"},
                                                              {SDLK_BACKSPACE, "backspace"},
                                                              {SDLK_SPACE, "space"},
                                                              {SDLK_RETURN, "enter"},
                                                              {SDLK_KP_ENTER, "enter"},
                                                              {SDLK_ESCAPE, "escape"},
                                                              {SDLK_a, "a"},
                                                              {SDLK_b, "b"},
                                                              {SDLK_h, "h"},
                                                              {SDLK_c, "c"},
                                                              {SDLK_v, "v"},
                                                              {SDLK_x, "x"},
                                                              {SDLK_y, "y"},
                                                              {SDLK_z, "z"},
                                                              {SDLK_f, "f"},
                                                              {SDLK_r, "r"},
                                                              {SDLK_F1, "f1"},
                                                              {SDLK_PAGEUP, "page_up"},
                                                              {SDLK_PAGEDOWN, "page_down"},
                                                              {SDLK_LCTRL, "ctrl"},
                                                              {SDLK_RCTRL, "ctrl"},
                                                              {SDLK_LSHIFT, "shift"},
                                                              {SDLK_RSHIFT, "shift"}};
  for (const auto& [code, name] : kKeys)
    if (code == key)
      return static_cast<int>(std::find(key_names().begin(), key_names().end(), name) - key_names().begin());
  return -1;
}

int button_code(int button) {
  return button == SDL_BUTTON_LEFT ? 0 : button == SDL_BUTTON_RIGHT ? 1 : button == SDL_BUTTON_MIDDLE ? 2 : -1;
}

/// False when the window is closed.
bool take(const SDL_Event& event, Ui& ui) {
  switch (event.type) {
    case SDL_QUIT:
      return false;
    case SDL_MOUSEMOTION:
      ui.add({UiEvent::move, static_cast<float>(event.motion.x), static_cast<float>(event.motion.y)});
      break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      if (const int b = button_code(event.button.button); b >= 0) {
        ui.add({UiEvent::move, static_cast<float>(event.button.x), static_cast<float>(event.button.y)});
        ui.add({event.type == SDL_MOUSEBUTTONDOWN ? UiEvent::press : UiEvent::release, 0, 0, b});
      }
      break;
    case SDL_MOUSEWHEEL:
      ui.add({UiEvent::wheel, 0, static_cast<float>(event.wheel.y)});
      break;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
      if (const int k = key_code(event.key.keysym.sym); k >= 0)
        ui.add({event.type == SDL_KEYDOWN ? UiEvent::key_down : UiEvent::key_up, 0, 0, k});
      break;
    case SDL_TEXTINPUT:
      ui.add({UiEvent::type, 0, 0, 0, event.text.text});
      break;
    default:
      break;
  }
  return true;
}

}  // namespace

bool has_screen() {
  const auto is_set = [](const char* name) {
    const char* v = std::getenv(name);
    return v != nullptr && *v != 0;
  };
  return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

/// In the order of making; what is made later goes first.
struct Window::Parts {
  struct Desktop {
    Desktop() {
      SDL_SetHint(SDL_HINT_RENDER_DRIVER, "software");
      SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
      SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
      SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
      if (!has_screen()) refuse("there is no screen");
      if (SDL_Init(SDL_INIT_VIDEO) != 0) refuse(SDL_GetError());
      const std::string driver = SDL_GetCurrentVideoDriver();
      if (driver != "x11" && driver != "wayland") refuse(fmt::format("SDL's video driver '{}' has none", driver));
    }
    ~Desktop() { SDL_Quit(); }
  };
  Desktop desktop;
  std::unique_ptr<SDL_Window, void (*)(SDL_Window*)> window{nullptr, SDL_DestroyWindow};
  std::unique_ptr<SDL_Renderer, void (*)(SDL_Renderer*)> renderer{nullptr, SDL_DestroyRenderer};
  std::unique_ptr<SDL_Texture, void (*)(SDL_Texture*)> texture{nullptr, SDL_DestroyTexture};
  bool exposed = true, open = true;

  void handle(const SDL_Event& event, Ui& ui) {
    exposed |= event.type == SDL_WINDOWEVENT;
    open = take(event, ui);
  }
};

Window::Window(int width, int height, const std::string& title) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.window.reset(SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, width, height, 0));
  if (!p.window) refuse(SDL_GetError());
  p.renderer.reset(SDL_CreateRenderer(p.window.get(), -1, SDL_RENDERER_SOFTWARE));
  if (!p.renderer) refuse(SDL_GetError());
  p.texture.reset(
      SDL_CreateTexture(p.renderer.get(), SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STREAMING, width, height));
  if (!p.texture) refuse(SDL_GetError());
  // a window that is made larger shows the same, larger; the mouse goes with it
  SDL_RenderSetLogicalSize(p.renderer.get(), width, height);
  SDL_StartTextInput();
}

Window::~Window() = default;

bool Window::take_input(Ui& ui, int milliseconds) {
  SDL_Event event;
  if (milliseconds > 0 && SDL_WaitEventTimeout(&event, milliseconds)) parts_->handle(event, ui);
  while (parts_->open && SDL_PollEvent(&event)) parts_->handle(event, ui);
  return parts_->open;
}

bool Window::is_exposed() const { return parts_->exposed; }

void Window::show(const Image& image) {
  SDL_UpdateTexture(parts_->texture.get(), nullptr, image.pixel(0, 0), 3 * image.width);
  SDL_RenderCopy(parts_->renderer.get(), parts_->texture.get(), nullptr, nullptr);
  SDL_RenderPresent(parts_->renderer.get());
  parts_->exposed = false;
}

}  // namespace impinge
