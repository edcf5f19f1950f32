#include "viewer/web/web_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <thread>

#include "engine/core/error.hpp"
#include "viewer/web/web_session.hpp"

namespace impinge {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::beast::error_code;

constexpr int kMostSessions = 32;

tcp::endpoint endpoint_of(const WebServerOptions& options) {
  error_code error;
  const asio::ip::address address = asio::ip::make_address(options.address, error);
  if (error)
    throw InputError(
        fmt::format("command line: --listen is '{}'; an address in numbers is wanted, such as 127.0.0.1, 0.0.0.0 for "
                    "every network of this machine, or ::1; write one",
                    options.address));
  return {address, static_cast<unsigned short>(options.port)};
}

}  // namespace

struct WebServer::Parts {
  WebShared shared;
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  std::vector<std::weak_ptr<WebSession>> sessions;
  std::thread thread;

  void open() {
    const tcp::endpoint endpoint = endpoint_of(shared.options);
    try {
      acceptor.open(endpoint.protocol());
      acceptor.set_option(tcp::acceptor::reuse_address(true));
      acceptor.bind(endpoint);
      acceptor.listen();
    } catch (const boost::system::system_error& error) {
      throw InputError(
          fmt::format("command line: --web {}: {} port {} can't be listened on ({}); one that is free and allowed is "
                      "wanted; choose "
                      "another, or 0 for any",
                      shared.options.port, shared.options.address, shared.options.port, error.code().message()));
    }
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      std::erase_if(sessions, [](const auto& session) { return session.expired(); });
      if (!error && shared.open < kMostSessions) {
        const auto session = std::make_shared<WebSession>(std::move(socket), shared);
        sessions.push_back(session);
        session->start();
      }
      accept();
    });
  }
};

WebServer::WebServer(const WebServerOptions& options, std::function<void(UiEvent)> take)
    : parts_(std::make_unique<Parts>()) {
  parts_->shared.options = options;
  parts_->shared.take = std::move(take);
  parts_->open();
  parts_->accept();
  parts_->thread = std::thread([this] { parts_->context.run(); });
}

WebServer::~WebServer() {
  parts_->context.stop();
  parts_->thread.join();
}

int WebServer::port() const { return parts_->acceptor.local_endpoint().port(); }

void WebServer::show(std::shared_ptr<const Image> image) {
  asio::post(parts_->context, [parts = parts_.get(), image = std::move(image)]() mutable {
    parts->shared.image = std::move(image);
    ++parts->shared.number;
    for (const auto& session : parts->sessions)
      if (const auto s = session.lock()) s->send_picture();
  });
}

}  // namespace impinge
