// Where else than in a window of the desktop the debugger is shown: browsers, viewers of VNC. Options and their meaning.
#pragma once

#include "viewer/app/sub_command.hpp"
#include "viewer/present/screen.hpp"

namespace impinge {

struct DebugDoors {
  std::optional<int> web, vnc;  ///< ports
  std::string listen;           ///< address, "": this machine only
  std::filesystem::path password_file;

  void declare(Options& options);
  bool any() const { return web || vnc; }
  /// Throws InputError where the options don't go together.
  void check() const;
  /// Listens, and says where and with which password. Pixels. Throws InputError.
  std::vector<std::unique_ptr<Screen>> open(int width, int height, const std::string& title) const;
};

}  // namespace impinge
