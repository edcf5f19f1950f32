// Pictures to browsers and their input back, over HTTP and WebSocket (RFC 6455): the transport only. Boost.Beast does the
// protocols.
//
// A browser gets the page, opens a WebSocket and sends the password. From then on it gets pictures, and sends `seen` when it
// has drawn one: no more than one is under way to it, the newest. A message has 16 bytes, little-endian, x, y, width and
// height of what changed since that browser's last one, and the PNG file of these pixels: nothing is lost, what is seen is
// what was drawn.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "viewer/image/image.hpp"
#include "viewer/panels/debug/ui.hpp"

namespace impinge {

struct WebServerOptions {
  std::string address = "127.0.0.1";  ///< to listen on
  int port = 0;                       ///< 0: any that is free
  std::string password, title;
  int width = 0, height = 0;  ///< of the pictures, pixels
};

class WebServer {
 public:
  /// Serves in a thread of its own. `take`: called there with what browsers send. Throws InputError where the port or
  /// address can't be had.
  WebServer(const WebServerOptions& options, std::function<void(UiEvent)> take);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  /// Every browser is shown this next.
  void show(std::shared_ptr<const Image> image);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace impinge
