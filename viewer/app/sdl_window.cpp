// SDL's own ways to OpenGL and OSMesa in one process crash (both bring a dispatch table), so the window is drawn by
// SDL's software renderer: a streaming texture that gets the pixels.
#include "viewer/app/sdl_window.hpp"

#include <SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

constexpr std::uint64_t kNowAndThen = 3000;  // ms
constexpr int kIdle = 50;                    // ms to wait for input where nothing moves

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

struct Screen {
  Screen() {
    SDL_SetHint(SDL_HINT_RENDER_DRIVER, "software");
    SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    if (!has_screen()) refuse("there is no screen");
    if (SDL_Init(SDL_INIT_VIDEO) != 0) refuse(SDL_GetError());
    const std::string driver = SDL_GetCurrentVideoDriver();
    if (driver != "x11" && driver != "wayland") refuse(fmt::format("SDL's video driver '{}' has none", driver));
  }
  ~Screen() { SDL_Quit(); }
};

}  // namespace

bool has_screen() {
  const auto is_set = [](const char* name) {
    const char* v = std::getenv(name);
    return v != nullptr && *v != 0;
  };
  return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

void show_window(DebugLoop& loop, DebugWindow& pixels, const std::string& title, const std::atomic<bool>& interrupted,
                 const std::function<void()>& now_and_then) {
  const Screen screen;
  const int w = pixels.width(), h = pixels.height();
  const std::unique_ptr<SDL_Window, void (*)(SDL_Window*)> window(
      SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, w, h, 0), SDL_DestroyWindow);
  if (!window) refuse(SDL_GetError());
  const std::unique_ptr<SDL_Renderer, void (*)(SDL_Renderer*)> renderer(
      SDL_CreateRenderer(window.get(), -1, SDL_RENDERER_SOFTWARE), SDL_DestroyRenderer);
  if (!renderer) refuse(SDL_GetError());
  const std::unique_ptr<SDL_Texture, void (*)(SDL_Texture*)> texture(
      SDL_CreateTexture(renderer.get(), SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STREAMING, w, h), SDL_DestroyTexture);
  if (!texture) refuse(SDL_GetError());
  // a window that is made larger shows the same, larger; the mouse goes with it
  SDL_RenderSetLogicalSize(renderer.get(), w, h);
  SDL_StartTextInput();
  Image image;
  bool open = true, exposed = true;
  std::uint64_t called = SDL_GetTicks64();
  const auto handle = [&](const SDL_Event& event) {
    exposed |= event.type == SDL_WINDOWEVENT;
    open = take(event, pixels.ui());
  };
  while (open && !loop.has_quit() && !interrupted) {
    const std::uint64_t start = SDL_GetTicks64();
    SDL_Event event;
    if (!loop.is_busy() && SDL_WaitEventTimeout(&event, kIdle)) handle(event);
    while (open && SDL_PollEvent(&event)) handle(event);
    loop.tick();
    if (pixels.has_changed() || exposed) {
      pixels.read(image);
      SDL_UpdateTexture(texture.get(), nullptr, image.pixel(0, 0), 3 * w);
      SDL_RenderCopy(renderer.get(), texture.get(), nullptr, nullptr);
      SDL_RenderPresent(renderer.get());
      exposed = false;
    }
    if (start - called > kNowAndThen) now_and_then(), called = start;
    const std::uint64_t taken = SDL_GetTicks64() - start;
    if (const auto frame = static_cast<std::uint64_t>(1e3 * loop.seconds_to_show()); taken < frame)
      SDL_Delay(static_cast<std::uint32_t>(frame - taken));
  }
}

}  // namespace impinge
