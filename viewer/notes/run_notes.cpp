#include "viewer/notes/run_notes.hpp"

#include "viewer/notes/note_archive.hpp"

namespace impinge {

void RunNotes::add(const FrameStats& stats) {
  convergence.add(stats);
  watchdog.add(stats);
}

void RunNotes::add(const World& world, bool is_driven) {
  balance.add(world, is_driven);
  swell.add(world);
  crossing.add(world);
}

std::string RunNotes::text() const {
  return convergence.text() + watchdog.text() + balance.text() + swell.text() + crossing.text() + empty.text();
}

void RunNotes::keep(NoteArchive& archive) {
  convergence.keep(archive);
  watchdog.keep(archive);
  balance.keep(archive);
  swell.keep(archive);
  crossing.keep(archive);
  empty.keep(archive);
  archive.list(told, [&](std::string& line) { archive.keep(line); });
}

std::string RunNotes::saved() {
  ByteWriter out;
  NoteArchive archive(out);
  keep(archive);
  return out.take();
}

void RunNotes::restore(std::string_view saved) {
  if (saved.empty()) return;
  ByteReader in(saved);
  NoteArchive archive(in);
  keep(archive);
}

}  // namespace impinge
