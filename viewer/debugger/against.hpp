// A second session beside the debugger's, frame by frame: A is what is looked at and changed, B what it is held against.
#pragma once

#include <filesystem>

#include "engine/world/stage_watch.hpp"
#include "viewer/controller/session.hpp"
#include "viewer/state/against_model.hpp"

namespace impinge {

/// What B is.
struct AgainstSource {
  std::filesystem::path scene;  ///< "": nothing is compared
  std::vector<std::string> overrides;
  std::filesystem::path script;
  std::string label;
};

class Against {
 public:
  /// Throws InputError.
  Against(const AgainstSource& source, const SessionOptions& options);

  /// Makes B's frames up to the one at which A is. `hashes` are A's by frame, as far as they are known. Throws Interrupted,
  /// B then as before.
  void reach(const StepRecord& a, const std::vector<std::uint64_t>& hashes, int frame);
  /// A's frames after it are no longer what they were.
  void forget_after(int frame);
  /// The first frame in which they differ, where it was found since the last call.
  std::optional<int> take_news();
  /// The first frame in which positions differ, where there was none with the first difference: found since the last call,
  /// in words; "": not found.
  std::string take_apart();
  /// Whether A went past the first frame in which they differ, so that nobody looked at both in it.
  bool lacks_fields() const { return first_ >= 0 && fields_.empty(); }
  /// From A's record of that frame, and what is known of B's.
  void take_fields(const StepRecord& a);
  /// In what, in words. `stages` are A's of that frame, null: not known.
  const std::string& tell(int frame, const FrameStages* stages);
  const AgainstModel& model() const { return model_; }

 private:
  bool advance();
  void compare(const std::vector<std::uint64_t>& hashes, int frame);
  void compare_places(const StepRecord& a, int frame);

  Session session_;
  AgainstModel model_;
  std::vector<std::uint64_t> hashes_;  // by frame
  FrameStages stages_;                 // of the last frame, as long as no difference is known
  int same_ = 0;                       // so many frames were held against A's and are the same
  int first_ = -1;                     // frame in which they differ
  bool is_news_ = false;
  std::string fields_;   // in what, in that frame
  int same_place_ = -1;  // the last frame in which they differ and all positions are the same; -1: not sought
  int apart_ = -1;       // and the first with others; -1: not known
  std::string apart_fields_;
};

}  // namespace impinge
