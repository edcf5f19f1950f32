// All that a run says of its own answer at the end. What is known after a frame is kept with the frame's snapshot, so a
// run that goes on says the same as one that was never interrupted.
#pragma once

#include "viewer/notes/balance_note.hpp"
#include "viewer/notes/convergence_note.hpp"
#include "viewer/notes/crossing_note.hpp"
#include "viewer/notes/empty_note.hpp"
#include "viewer/notes/swell_note.hpp"
#include "viewer/notes/watchdog_note.hpp"

namespace impinge {

struct RunNotes {
  ConvergenceNote convergence;
  WatchdogNote watchdog;
  BalanceNote balance;
  SwellNote swell;
  CrossingNote crossing;
  EmptyNote empty;
  std::vector<std::string> told;  ///< lines that were said at once, of frames so far

  /// A frame's figures; the world at its end, and whether something is driven.
  void add(const FrameStats& stats);
  void add(const World& world, bool is_driven);
  /// Their lines with their ends, "" if there is nothing to say.
  std::string text() const;
  /// What they know so far, which stays as it is: one list of members serves both ways. Energies of frames are not among
  /// it, these are in the run's table.
  std::string saved();
  /// After add_earlier() of every frame so far; nothing of an older version.
  void restore(std::string_view saved);

 private:
  void keep(NoteArchive& archive);
};

}  // namespace impinge
