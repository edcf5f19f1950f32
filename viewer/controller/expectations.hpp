// `expect` lines of a script, judged frame by frame.
#pragma once

#include <functional>
#include <set>

#include "viewer/controller/condition_values.hpp"
#include "viewer/controller/script.hpp"

namespace impinge {

class Expectations {
 public:
  /// `report` gets one line for each failure. The script must outlive this.
  /// `judged`: the figures have those of --judge. `pictures`: `expect image` lines are judged too.
  Expectations(const Script& script, bool judged, bool pictures, std::function<void(const std::string&)> report)
      : script_(script), judged_(judged), pictures_(pictures), report_(std::move(report)) {}

  /// Judges the frame's `expect` lines of these bodies; `picture` gives the frame's PNG, which must be on the disk where
  /// one is compared.
  void check(int frame, const ConditionValues& values, const Bodies& bodies,
             const std::function<std::filesystem::path()>& picture);
  /// Whether one of the frame's lines asks of bodies: then the figures alone don't judge it.
  bool asks_of_bodies(int frame) const;
  bool needs_picture(int frame) const;
  /// At the end: in how many frames lines failed that are of several, and how many lie after the last frame.
  void tell_rest(int last_frame) const;
  /// Lines that failed, however many of their frames.
  int failures() const { return failures_; }

 private:
  std::string no_answer(int frame, const Expression& condition, const Bodies& bodies) const;

  const Script& script_;
  bool judged_ = false, pictures_ = true;
  std::function<void(const std::string&)> report_;
  std::vector<std::set<int>> failed_;  // of each line with a condition, the frames
  int failures_ = 0;
};

}  // namespace impinge
