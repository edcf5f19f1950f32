// What lines changed in a model or a view, so that it can be taken back, and what was taken back, so that it can be done
// again. Each keeps what it replaced; taking it back exchanges that for what is there now.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "viewer/controller/command.hpp"

namespace impinge {

/// What is known of the frames after one, and what was asked for by hand in them.
struct Future {
  int frame = 0;
  std::map<int, std::vector<Command>> by_hand;
  std::set<int> changed_frames;
  std::vector<std::vector<double>> history, own;  ///< figures, and values of the scene's own columns
  std::vector<std::uint64_t> hashes;
  int folder_last = -1;  ///< up to where a run's folder has their states
};

struct Edit {
  std::optional<Future> future;                                   ///< of a change of the model
  std::vector<std::pair<const Parameter*, ParameterValue>> view;  ///< rows that it changed, as they were
  std::string dragged = {};                                       ///< the body that is pulled, as long as it goes on
};

class Edits {
 public:
  void done(Edit edit) { undone_.clear(), done_.push_back(std::move(edit)); }
  /// The last two are one from now on.
  void merge_last() { done_.pop_back(); }
  /// The body that the last change pulls, "": it is no pull.
  std::string dragged() const { return done_.empty() ? "" : done_.back().dragged; }
  void end_drag() { done_.back().dragged.clear(); }
  void forget() { done_.clear(), undone_.clear(); }

  std::vector<Edit>& done() { return done_; }
  std::vector<Edit>& undone() { return undone_; }

 private:
  std::vector<Edit> done_, undone_;
};

}  // namespace impinge
