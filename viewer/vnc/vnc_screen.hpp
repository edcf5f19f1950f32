// Viewers of VNC (RFB 3.8) as a screen of the debugger, through LibVNCServer. That library is GPL: a program built with it
// is too, so it is an option of the build.
#pragma once

#include <memory>
#include <string>

#include "viewer/present/screen.hpp"

namespace impinge {

struct VncScreenOptions {
  std::string address = "127.0.0.1";  ///< to listen on, IPv4
  int port = 5900;
  std::string password;  ///< 8 characters: the protocol looks at no more
  std::string title;
  int width = 0, height = 0;  ///< pixels
};

/// Whether this build has it.
bool has_vnc();
/// Throws InputError where the port or address can't be had, or has_vnc() is false.
std::unique_ptr<Screen> make_vnc_screen(const VncScreenOptions& options);

}  // namespace impinge
