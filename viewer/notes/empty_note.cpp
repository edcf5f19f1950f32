#include "viewer/notes/empty_note.hpp"

#include <fmt/format.h>

#include "engine/world/step_record.hpp"
#include "viewer/draw/box_in_picture.hpp"
#include "viewer/draw/view_settings.hpp"
#include "viewer/layers/view_bodies.hpp"
#include "viewer/notes/note_archive.hpp"

namespace impinge {

void EmptyNote::add(const StepRecord& record, const ViewSettings& settings, int width, int height) {
  const Camera camera = camera_of_picture(record, settings, static_cast<double>(width) / height);
  const BodySet left_out = not_drawn(record, settings);
  bool moves = false;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const BodyRecord& body = record.bodies[i];
    if (body.kind == BodyKind::fixed || body.bounds.is_empty() || left_out.has(BodyIndex(static_cast<int>(i))))
      continue;
    moves = true;
    if (!box_in_picture(body.bounds, camera, width, height).is_in) continue;
    if (count_ == 0) last_seen_ = body.name;
    return;
  }
  if (!moves) return;
  if (count_++ == 0) first_ = record.stats.frame;
}

void EmptyNote::keep(NoteArchive& archive) { archive.keep(first_, count_, last_seen_); }

std::string EmptyNote::text() const {
  if (count_ == 0) return "";
  const std::string follow =
      last_seen_.empty() ? ""
                         : fmt::format(", or view.camera.follow = \"{}\", which was the last to be seen", last_seen_);
  return fmt::format(
      "note:     nothing that moves is in {} of the pictures, frame {} the first of them; set view.camera.fit = "
      "\"all\"{}\n",
      count_, first_, follow);
}

}  // namespace impinge
