#include "viewer/web/web_session.hpp"

#include <fmt/format.h>

#include <map>

#include "viewer/image/changed_area.hpp"
#include "viewer/image/png.hpp"
#include "viewer/web/password.hpp"
#include "viewer/web/web_input.hpp"

namespace impinge {

const std::map<std::string, std::string>& web_page_sources();

namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using beast::error_code;

constexpr auto kPatience = std::chrono::seconds(10);  // with who has not said who he is
constexpr auto kPenalty = std::chrono::seconds(1);    // for a wrong password
constexpr std::size_t kMostMessage = 1024, kMostHeader = 8192;

void put(std::string& out, int value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift);
}

/// The message that turns what a browser shows into the picture.
std::string picture_message(const Image& image, const PixelArea& area) {
  Image part(area.width, area.height);
  for (int y = 0; y < area.height; ++y) std::copy_n(image.pixel(area.x, area.y + y), 3 * area.width, part.pixel(0, y));
  std::string message;
  for (const int value : {area.x, area.y, area.width, area.height}) put(message, value);
  return message + encode_png(part);
}

}  // namespace

WebSession::WebSession(boost::asio::ip::tcp::socket socket, WebShared& shared)
    : shared_(shared), socket_(std::move(socket)), delay_(socket_.get_executor()) {
  parser_.header_limit(kMostHeader);
  parser_.body_limit(0);
  ++shared_.open;
}

WebSession::~WebSession() {
  release_all();
  --shared_.open;
}

/// Nothing stays pressed by who has gone.
void WebSession::release_all() {
  for (const int code : keys_) shared_.take({UiEvent::key_up, 0, 0, code});
  for (const int code : buttons_) shared_.take({UiEvent::release, 0, 0, code});
  keys_.clear(), buttons_.clear();
}

void WebSession::start() {
  beast::get_lowest_layer(socket_).expires_after(kPatience);
  http::async_read(socket_.next_layer(), buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
    if (!error) self->answer(self->parser_.get());
  });
}

/// A page of another origin that a browser on this machine shows must not reach us through it.
bool WebSession::is_from_our_page(const Request& request) const {
  const auto origin = request.find(http::field::origin), host = request.find(http::field::host);
  if (origin == request.end()) return true;  // no browser
  return host != request.end() && origin->value() == "http://" + std::string(host->value());
}

void WebSession::answer(const Request& request) {
  const bool wants_session = request.target() == "/session";
  if (wants_session && websocket::is_upgrade(request) && is_from_our_page(request)) return accept(request);
  const bool has_page = request.target() == "/" && (request.method() == http::verb::get);
  response_ = std::make_shared<Response>(has_page        ? http::status::ok
                                         : wants_session ? http::status::forbidden
                                                         : http::status::not_found,
                                         request.version());
  response_->set(http::field::content_type, has_page ? "text/html; charset=utf-8" : "text/plain");
  response_->set(http::field::cache_control, "no-store");
  response_->set("X-Frame-Options", "DENY");
  response_->set("Content-Security-Policy",
                 "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src 'self'; "
                 "img-src blob: data:; frame-ancestors 'none'");
  response_->body() = has_page ? web_page_sources().at("index.html") : "there is nothing here\n";
  response_->keep_alive(false);
  response_->prepare_payload();
  http::async_write(socket_.next_layer(), *response_, [self = shared_from_this()](error_code, std::size_t) {
    error_code ignored;
    beast::get_lowest_layer(self->socket_).socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  });
}

void WebSession::accept(const Request& request) {
  beast::get_lowest_layer(socket_).expires_never();
  websocket::stream_base::timeout patience = websocket::stream_base::timeout::suggested(beast::role_type::server);
  patience.handshake_timeout = kPatience;
  socket_.set_option(patience);  // who is silent is asked, who does not answer has gone
  socket_.read_message_max(kMostMessage);
  socket_.async_accept(request, [self = shared_from_this()](error_code error) {
    if (error) return;
    self->buffer_.clear();
    self->delay_.expires_after(kPatience);
    self->delay_.async_wait([self](error_code cancelled) {
      if (!cancelled && !self->is_let_in_) self->close(websocket::close_code::policy_error);
    });
    self->read();
  });
}

void WebSession::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) {  // gone
      self->delay_.cancel();
      return self->release_all();
    }
    const std::string message = beast::buffers_to_string(self->buffer_.data());
    self->buffer_.clear();
    self->hear(message);
    if (!self->is_closing_) self->read();
  });
}

void WebSession::hear(const std::string& message) {
  if (!is_let_in_) return check_password(message);
  if (message == "seen") {
    is_unseen_ = false;
    return send_picture();
  }
  std::optional<UiEvent> event = parse_web_event(message, shared_.options.width, shared_.options.height);
  if (!event) return close(websocket::close_code::policy_error);
  if (event->kind == UiEvent::press) buttons_.insert(event->code);
  if (event->kind == UiEvent::release) buttons_.erase(event->code);
  if (event->kind == UiEvent::key_down) keys_.insert(event->code);
  if (event->kind == UiEvent::key_up) keys_.erase(event->code);
  shared_.take(std::move(*event));
}

void WebSession::check_password(const std::string& message) {
  static constexpr std::string_view kVerb = "password ";
  const bool is_right = message.starts_with(kVerb) &&
                        is_same_password(std::string_view(message).substr(kVerb.size()), shared_.options.password);
  delay_.cancel();
  if (is_right) {
    is_let_in_ = true;
    return say(fmt::format("size {} {} {}", shared_.options.width, shared_.options.height, shared_.options.title),
               false);
  }
  is_closing_ = true;  // nothing more is read
  delay_.expires_after(kPenalty);
  delay_.async_wait([self = shared_from_this()](error_code cancelled) {
    if (!cancelled) self->say("refused", true);
  });
}

void WebSession::say(const std::string& text, bool then_close) {
  sending_ = text;
  is_writing_ = true;
  socket_.text(true);
  socket_.async_write(boost::asio::buffer(sending_),
                      [self = shared_from_this(), then_close](error_code error, std::size_t) {
                        self->is_writing_ = false;
                        if (error) return;
                        if (then_close) return self->close(websocket::close_code::policy_error);
                        self->send_picture();
                      });
}

void WebSession::send_picture() {
  if (!is_let_in_ || is_writing_ || is_unseen_ || is_closing_ || !shared_.image || sent_number_ == shared_.number)
    return;
  const PixelArea area = sent_ ? changed_area(*sent_, *shared_.image) : whole_area(*shared_.image);
  sent_ = shared_.image, sent_number_ = shared_.number;
  if (area.width == 0) return;
  sending_ = picture_message(*sent_, area);
  is_writing_ = is_unseen_ = true;
  socket_.binary(true);
  socket_.async_write(boost::asio::buffer(sending_), [self = shared_from_this()](error_code error, std::size_t) {
    self->is_writing_ = false;
    if (!error) self->send_picture();  // if it was seen and has changed meanwhile
  });
}

void WebSession::close(websocket::close_code code) {
  is_closing_ = true;
  socket_.async_close(code, [self = shared_from_this()](error_code) { self->release_all(); });
}

}  // namespace impinge
