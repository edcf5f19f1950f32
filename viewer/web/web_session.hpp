// One browser: its requests, then its WebSocket. Used in the server's thread only.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <set>

#include "viewer/web/web_server.hpp"

namespace impinge {

/// What all browsers share.
struct WebShared {
  WebServerOptions options;
  std::function<void(UiEvent)> take;
  std::shared_ptr<const Image> image;  // the newest
  int number = 0;                      // of it, from 1
  int open = 0;                        // sessions
};

class WebSession : public std::enable_shared_from_this<WebSession> {
 public:
  WebSession(boost::asio::ip::tcp::socket socket, WebShared& shared);
  ~WebSession();

  void start();
  /// Sends the newest picture, unless one is under way or nothing has changed.
  void send_picture();

 private:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;
  using Response = boost::beast::http::response<boost::beast::http::string_body>;

  void answer(const Request& request);
  bool is_from_our_page(const Request& request) const;
  void accept(const Request& request);
  void read();
  void hear(const std::string& message);
  void check_password(const std::string& message);
  void say(const std::string& text, bool then_close);
  void close(boost::beast::websocket::close_code code);
  void release_all();

  WebShared& shared_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  boost::beast::flat_buffer buffer_;
  boost::beast::http::request_parser<boost::beast::http::string_body> parser_;
  std::shared_ptr<Response> response_;
  boost::asio::steady_timer delay_;
  std::string sending_;
  std::shared_ptr<const Image> sent_;  // the last picture that went to it
  int sent_number_ = 0;
  bool is_let_in_ = false, is_writing_ = false, is_unseen_ = false, is_closing_ = false;
  std::set<int> keys_, buttons_;  // that it holds down
};

}  // namespace impinge
