#include "viewer/app/debug_doors.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "viewer/vnc/vnc_screen.hpp"
#include "viewer/web/password.hpp"
#include "viewer/web/web_screen.hpp"

namespace impinge {
namespace {

constexpr std::size_t kVncLetters = 8;  // of a password that count

void warn_of_network(int port) {
  fmt::print(stderr,
             "others on the network can reach port {0}, and what goes through it is not encrypted; a tunnel is safer: "
             "leave --listen out and use ssh -L {0}:127.0.0.1:{0} HOST\n",
             port);
}

}  // namespace

void DebugDoors::declare(Options& options) {
  options.whole("--web", web, 0, 65535,
                "PORT: show it in browsers, at the address and with the password that are printed; 0: any free port");
  options.whole("--vnc", vnc, 1, 65535, "PORT: show it to viewers of VNC (where the build has it, -DIMPINGE_VNC=ON)");
  options.text(
      "--listen", listen,
      "ADDRESS that --web and --vnc listen on (default: 127.0.0.1, this machine only; 0.0.0.0: every network)");
  options.path("--password-file", password_file,
               "file whose first line is their password (default: a new one each time; VNC takes 8 characters)");
}

void DebugDoors::check() const {
  for (const auto& [name, given] :
       {std::pair("--listen", !listen.empty()), std::pair("--password-file", !password_file.empty())})
    if (given && !any())
      refuse_option(fmt::format("{} without --web or --vnc", name), "it is for those", "add one, or leave it out");
  if (vnc && web && *vnc == *web)
    refuse_option(fmt::format("--web and --vnc both on port {}", *web), "each wants its own", "change one");
}

std::vector<std::unique_ptr<Screen>> DebugDoors::open(int width, int height, const std::string& title) const {
  std::vector<std::unique_ptr<Screen>> screens;
  const bool is_local = listen.empty() || listen.starts_with("127.") || listen == "::1";
  const std::string address = listen.empty() ? "127.0.0.1" : listen;
  std::string password = password_file.empty() ? random_password() : read_password(password_file);
  if (vnc && password_file.empty()) password.resize(kVncLetters);  // one for both
  if (vnc && password.size() > kVncLetters)
    throw InputError(
        fmt::format("{}:1: a password of {} characters with --vnc; VNC looks at the first {} only, so that many are "
                    "wanted; shorten "
                    "it, or use --web alone",
                    password_file.string(), password.size(), kVncLetters));
  const std::string said = password_file.empty() ? fmt::format("(password {})", password)
                                                 : fmt::format("(password in {})", password_file.string());
  if (web) {
    auto screen = std::make_unique<WebScreen>(WebServerOptions{address, *web, password, title, width, height});
    const bool is_any = address == "0.0.0.0" || address == "::";
    const std::string host = is_any                                   ? "localhost"
                             : address.find(':') != std::string::npos ? "[" + address + "]"
                                                                      : address;
    fmt::print(stderr, "web: http://{}:{}/{}   {}\n", host, screen->port(), password_file.empty() ? "#" + password : "",
               said);
    if (!is_local) warn_of_network(screen->port());
    screens.push_back(std::move(screen));
  }
  if (vnc) {
    screens.push_back(make_vnc_screen({address, *vnc, password, title, width, height}));
    fmt::print(stderr, "vnc: {}:{}   {}\n", address, *vnc, said);
    if (!is_local) warn_of_network(*vnc);
  }
  return screens;
}

}  // namespace impinge
