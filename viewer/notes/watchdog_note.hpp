// What a run must not keep to its table: bodies that may have passed others, and, where somebody judged, how deep
// bodies overlap.
#pragma once

#include <map>
#include <string_view>

#include "engine/world/step_record.hpp"

namespace impinge {

class NoteArchive;

/// How the closing line of a judged run says that something is wrong.
inline constexpr std::string_view kPassedMark = "passed through", kDeepMark = "overlap by",
                                  kUnseenMark = "bodies may have passed others";

class WatchdogNote {
 public:
  /// Whether somebody looked for overlap and passages.
  void set_judged(bool judged) { judged_ = judged; }
  void add(const FrameStats& stats);
  /// Frames of an earlier process, of which only the number of unsafe motions is known.
  void add_earlier(int frame, double unsafe_motions);

  bool has_barked() const { return frames_ > 0 || is_deep() || is_sunk(); }
  /// Lines with their ends: each body with frame, sub-step, displacement and remedy; "" if every motion was safe.
  std::string text() const;
  /// The last line of a run, with its end; "" if there is nothing to say and nobody judged.
  std::string closing_line() const;
  void keep(NoteArchive& archive);

 private:
  struct Seen {
    UnsafeBody what;
    int frame = 0, substeps = 0;
  };
  bool is_deep() const;
  bool is_sunk() const;
  std::string how_deep() const;
  std::vector<const Seen*> worth_naming() const;

  bool judged_ = false;
  std::map<std::string, Seen> bodies_;  // the first of each, or the first that passed
  int frames_ = 0, first_frame_ = 0;    // with unsafe motions
  Crossing deepest_;                    // by its share; of a run that nobody judges as contacts tell it
  int deepest_frame_ = 0;
};

}  // namespace impinge
