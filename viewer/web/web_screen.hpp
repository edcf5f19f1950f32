// Browsers as a screen of the debugger: the same pixels, one queue of input.
#pragma once

#include <condition_variable>
#include <mutex>

#include "viewer/present/screen.hpp"
#include "viewer/web/web_server.hpp"

namespace impinge {

class WebScreen : public Screen {
 public:
  /// Throws InputError where the port or address can't be had.
  explicit WebScreen(const WebServerOptions& options);

  int port() const { return server_.port(); }
  /// Never closed: browsers come and go.
  bool take_input(Ui& ui, int milliseconds) override;
  bool is_exposed() const override { return !has_shown_; }
  void show(const Image& image) override;

 private:
  void take(UiEvent event);

  std::mutex mutex_;
  std::condition_variable has_input_;
  std::deque<UiEvent> input_;
  bool has_shown_ = false;
  WebServer server_;  // last: its thread uses the others
};

}  // namespace impinge
