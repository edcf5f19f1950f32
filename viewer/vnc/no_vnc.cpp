#include "engine/core/error.hpp"
#include "viewer/vnc/vnc_screen.hpp"

namespace impinge {

bool has_vnc() { return false; }

std::unique_ptr<Screen> make_vnc_screen(const VncScreenOptions&) {
  throw InputError(
      "command line: --vnc: this build has no VNC; --web PORT for a browser is there; or build with "
      "-DIMPINGE_VNC=ON, which needs libvncserver-dev and makes the program GPL");
}

}  // namespace impinge
