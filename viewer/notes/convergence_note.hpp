// What a run must not keep to its table: group solves that ended without an answer, and what ended them; and impacts that
// were one where they should have been several.
#pragma once

#include "engine/world/step_record.hpp"

namespace impinge {

class NoteArchive;

class ConvergenceNote {
 public:
  void add(const FrameStats& stats);
  /// A line for each with its end, "" if every solve had an answer, or as good as one, and every impact its turn.
  std::string text() const;
  void keep(NoteArchive& archive);

 private:
  std::string impacts_text() const;

  std::vector<UnsolvedGroups> causes_;  // in the order in which they came
  std::int64_t solves_ = 0;
  int frames_ = 0, worst_frame_ = 0;
  double worst_ = 0.0;  // m/s
  bool is_worth_a_word_ = false;
  int merged_ = 0, first_merged_ = 0;
};

}  // namespace impinge
