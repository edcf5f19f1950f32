#include "viewer/vnc/vnc_screen.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <rfb/rfb.h>

#include <array>
#include <set>

#include "engine/core/error.hpp"
#include "viewer/image/changed_area.hpp"
#include "viewer/vnc/vnc_keys.hpp"

namespace impinge {
namespace {

constexpr int kBytes = 4;  // of a pixel
constexpr int kWheelUp = 1 << 3, kWheelDown = 1 << 4;
constexpr int kMasks[] = {1, 4, 2};  // of button_names(): left, right, middle

class VncScreen : public Screen {
 public:
  explicit VncScreen(const VncScreenOptions& options)
      : title_(options.title), password_(options.password), shown_(options.width, options.height) {
    in_addr address{};
    if (inet_pton(AF_INET, options.address.c_str(), &address) != 1)
      throw InputError(
          fmt::format("command line: --listen is '{}'; for --vnc an IPv4 address in numbers is wanted, such as "
                      "127.0.0.1 or 0.0.0.0; "
                      "write one",
                      options.address));
    rfbLogEnable(0);
    server_.reset(rfbGetScreen(nullptr, nullptr, options.width, options.height, 8, 3, kBytes));
    IMPINGE_ASSERT(server_ != nullptr);
    pixels_.assign(static_cast<std::size_t>(options.width) * options.height * kBytes, '\0');
    rfbScreenInfo& s = *server_;
    s.frameBuffer = pixels_.data();
    s.serverFormat.redShift = 0, s.serverFormat.greenShift = 8, s.serverFormat.blueShift = 16;
    s.desktopName = title_.c_str();
    s.listenInterface = address.s_addr;
    s.port = options.port;
    s.ipv6port = 0;
    s.autoPort = FALSE;
    s.httpDir = nullptr;
    s.cursor = nullptr;
    s.alwaysShared = TRUE;
    s.deferUpdateTime = 0;
    passwords_ = {password_.data(), nullptr};
    s.authPasswdData = passwords_.data();
    s.passwordCheck = rfbCheckPasswordByList;
    s.screenData = this;
    s.kbdAddEvent = [](rfbBool down, rfbKeySym symbol, rfbClientPtr client) { of(client).key(down != 0, symbol); };
    s.ptrAddEvent = [](int mask, int x, int y, rfbClientPtr client) { of(client).pointer(mask, x, y); };
    s.newClientHook = [](rfbClientPtr client) {
      client->clientGoneHook = [](rfbClientPtr gone) { of(gone).release_all(); };
      return RFB_CLIENT_ACCEPT;
    };
    rfbInitServer(&s);
    if (s.listenSock < 0)
      throw InputError(
          fmt::format("command line: --vnc {}: {} port {} can't be listened on; one that is free and allowed is "
                      "wanted; choose another",
                      options.port, options.address, options.port));
  }
  ~VncScreen() override { rfbShutdownServer(server_.get(), TRUE); }

  bool take_input(Ui& ui, int milliseconds) override {
    rfbProcessEvents(server_.get(), 1000L * milliseconds);
    for (; !input_.empty(); input_.pop_front()) ui.add(std::move(input_.front()));
    return true;
  }
  bool is_exposed() const override { return !has_shown_; }
  void show(const Image& image) override {
    const PixelArea area = has_shown_ ? changed_area(shown_, image) : whole_area(image);
    for (int y = area.y; y < area.y + area.height; ++y)
      for (int x = area.x; x < area.x + area.width; ++x)
        std::copy_n(image.pixel(x, y), 3, &pixels_[(static_cast<std::size_t>(y) * image.width + x) * kBytes]);
    shown_ = image, has_shown_ = true;
    if (area.width > 0) rfbMarkRectAsModified(server_.get(), area.x, area.y, area.x + area.width, area.y + area.height);
  }

 private:
  static VncScreen& of(rfbClientPtr client) { return *static_cast<VncScreen*>(client->screen->screenData); }

  void key(bool down, std::uint32_t symbol) {
    const int code = key_of_symbol(symbol);
    if (code >= 0) {
      input_.push_back({down ? UiEvent::key_down : UiEvent::key_up, 0, 0, code});
      down ? void(keys_.insert(code)) : void(keys_.erase(code));
    }
    static const int ctrl = key_of_symbol(0xffe3);
    const std::string text = text_of_symbol(symbol);
    if (down && !text.empty() && !keys_.contains(ctrl)) input_.push_back({UiEvent::type, 0, 0, 0, text});
  }
  void pointer(int mask, int x, int y) {
    input_.push_back({UiEvent::move, static_cast<float>(x), static_cast<float>(y)});
    for (int b = 0; b < 3; ++b)
      if (((mask ^ mask_) & kMasks[b]) != 0)
        input_.push_back({(mask & kMasks[b]) != 0 ? UiEvent::press : UiEvent::release, 0, 0, b});
    for (const auto& [bit, way] : {std::pair(kWheelUp, 1.0f), std::pair(kWheelDown, -1.0f)})
      if ((mask & bit) != 0 && (mask_ & bit) == 0) input_.push_back({UiEvent::wheel, 0, way});
    mask_ = mask;
  }
  /// Nothing stays pressed by who has gone.
  void release_all() {
    for (const int code : keys_) input_.push_back({UiEvent::key_up, 0, 0, code});
    keys_.clear();
    for (int b = 0; b < 3; ++b)
      if ((mask_ & kMasks[b]) != 0) input_.push_back({UiEvent::release, 0, 0, b});
    mask_ = 0;
  }

  std::string title_, password_;
  std::array<char*, 2> passwords_{};
  std::string pixels_;
  Image shown_;
  bool has_shown_ = false;
  std::deque<UiEvent> input_;
  std::set<int> keys_;  // that are down
  int mask_ = 0;        // of buttons
  std::unique_ptr<rfbScreenInfo, void (*)(rfbScreenInfo*)> server_{nullptr, rfbScreenCleanup};
};

}  // namespace

bool has_vnc() { return true; }

std::unique_ptr<Screen> make_vnc_screen(const VncScreenOptions& options) {
  return std::make_unique<VncScreen>(options);
}

}  // namespace impinge
