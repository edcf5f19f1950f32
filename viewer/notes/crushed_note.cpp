#include "viewer/notes/crushed_note.hpp"

#include <fmt/format.h>

namespace impinge {

std::string crushed_note(std::span<const CrushedBody> bodies) {
  std::string lines;
  for (const CrushedBody& b : bodies) {
    lines += fmt::format("note:     '{}' {}: of {} tetrahedra ", b.name, kCrushedMark, b.elements);
    if (b.inverted > 0) lines += fmt::format("{} {} inverted", b.inverted, b.inverted == 1 ? "is" : "are");
    if (b.inverted > 0 && b.collapsed > 0) lines += ", ";
    if (b.collapsed > 0)
      lines += fmt::format("{} {} squeezed below {:.3g} of a length, where {} yields and may stay so", b.collapsed,
                           b.collapsed == 1 ? "is" : "are", b.stretch, b.model);
    lines += b.model == "neo_hookean" ? "; use more sub-steps\n" : "; use material.model = \"neo_hookean\"\n";
  }
  return lines;
}

}  // namespace impinge
