#include "viewer/web/web_screen.hpp"

#include <chrono>

namespace impinge {
namespace {

constexpr std::size_t kMostEvents = 10'000;  // that wait: more are a flood, not a user

}  // namespace

WebScreen::WebScreen(const WebServerOptions& options)
    : server_(options, [this](UiEvent event) { take(std::move(event)); }) {}

void WebScreen::take(UiEvent event) {
  const std::lock_guard lock(mutex_);
  // of moves that follow each other only the last is seen
  if (event.kind == UiEvent::move && !input_.empty() && input_.back().kind == UiEvent::move)
    input_.back() = std::move(event);
  else if (input_.size() < kMostEvents)
    input_.push_back(std::move(event));
  has_input_.notify_one();
}

bool WebScreen::take_input(Ui& ui, int milliseconds) {
  std::unique_lock lock(mutex_);
  if (milliseconds > 0)
    has_input_.wait_for(lock, std::chrono::milliseconds(milliseconds), [this] { return !input_.empty(); });
  for (; !input_.empty(); input_.pop_front()) ui.add(std::move(input_.front()));
  return true;
}

void WebScreen::show(const Image& image) {
  server_.show(std::make_shared<const Image>(image));
  has_shown_ = true;
}

}  // namespace impinge
