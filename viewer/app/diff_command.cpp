// impinge diff
#include "engine/core/error.hpp"
#include "viewer/app/commands.hpp"

namespace impinge {

int diff_command(const Arguments&) { throw InputError("command line: this program reads no pictures"); }

}  // namespace impinge
