// States of a session by frame, in bounded memory. Where they would take more, one goes: that which is missed least,
// since its neighbours are near it and the present is far. So states lie close together near the present and ever
// farther apart before it.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace impinge {

class SnapshotRing {
 public:
  /// `most`: bytes. The first and the last state are kept whatever they take.
  explicit SnapshotRing(std::size_t most) : most_(most) {}

  /// Replaces what is there of that frame.
  void put(int frame, std::string state);
  bool has(int frame) const { return states_.contains(frame); }
  /// The latest frame at or before this one that there is a state of.
  std::optional<int> at_or_before(int frame) const;
  const std::string& state(int frame) const { return states_.at(frame); }
  /// Forgets what comes after the frame.
  void cut(int frame);

  std::size_t bytes() const { return bytes_; }
  std::size_t most() const { return most_; }
  std::size_t count() const { return states_.size(); }

 private:
  std::size_t most_, bytes_ = 0;
  std::map<int, std::string> states_;
};

}  // namespace impinge
