#include "viewer/notes/crossing_note.hpp"

#include <fmt/format.h>

#include "engine/world/self_crossings.hpp"
#include "engine/world/world.hpp"
#include "viewer/notes/note_archive.hpp"

namespace impinge {

void CrossingNote::add(const World& world) {
  if (world.record().stats.self_crossings == 0) return;
  for (const Body& body : world.bodies()) {
    if (body.absent || body.deleted) continue;
    const std::int64_t count = count_self_crossings(body, CrossingsOf::self_colliding);
    if (count == 0) continue;
    Crossed& crossed = bodies_[body.name];
    if (world.frame() == 0) crossed.at_start = crossed.most = count;
    if (count <= crossed.most) continue;
    if (crossed.most == crossed.at_start) crossed.first = world.frame();
    crossed.most = count, crossed.worst = world.frame();
  }
}

void CrossingNote::keep(NoteArchive& archive) {
  archive.map(bodies_, [&](Crossed& c) { archive.keep(c.at_start, c.most, c.first, c.worst); });
}

std::string CrossingNote::text() const {
  std::string lines;
  for (const auto& [name, c] : bodies_) {
    if (c.most == c.at_start) continue;
    lines += fmt::format(
        "note:     '{}' {} from frame {} on, in frame {} with {} pair{} of triangles{}: contacts keep apart what has "
        "not "
        "crossed, and take long from there on; take more simulation.substeps, or a stiffer material\n",
        name, kCrossesMark, c.first, c.worst, c.most, c.most == 1 ? "" : "s",
        c.at_start > 0 ? fmt::format(", {} at the start", c.at_start) : "");
  }
  return lines;
}

}  // namespace impinge
