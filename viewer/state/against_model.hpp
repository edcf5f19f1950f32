// The other side of a comparison in the debugger: the same scene with another setting, or another scene, made beside it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/state/tracks.hpp"

namespace impinge {

struct AgainstModel {
  std::string label;              ///< what is different in it: "simulation.substeps=8"
  std::string parted;             ///< from which frame on, and in what; "" as long as they are the same
  std::string ended;              ///< why its frames go no farther; "": they do
  Tracks tracks;                  ///< of its frames
  std::vector<BodyIndex> bodies;  ///< by body of this side, the one of the same name there; none: there is none
  /// What is known by now.
  std::string words() const {
    return (parted.empty() ? "A and B (" + label + ") are the same" : parted) + (ended.empty() ? "" : "; " + ended);
  }
  /// Where a body of this side is there; none where it isn't known.
  std::optional<Pose> pose(int frame, BodyIndex body) const {
    const BodyIndex there = bodies[static_cast<std::size_t>(body.value())];
    return there.is_none() ? std::nullopt : tracks.pose(frame, there);
  }
};

}  // namespace impinge
