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
  std::string apart;              ///< from which on, and where, if that is later, something is elsewhere; "": not known
  std::string ended;              ///< why its frames go no farther; "": they do
  Tracks tracks = Tracks(true);   ///< of its frames
  std::vector<BodyIndex> bodies;  ///< by body of this side, the one of the same name there; none: there is none
  /// What is known by now.
  std::string words() const {
    return (parted.empty() ? "A and B (" + label + ") are the same" : parted) + (apart.empty() ? "" : "; " + apart) +
           (ended.empty() ? "" : "; " + ended);
  }
  BodyIndex other(BodyIndex body) const {
    const auto i = static_cast<std::size_t>(body.value());
    return i < bodies.size() ? bodies[i] : BodyIndex();
  }
  /// Where a body of this side is there; none where it isn't known.
  std::optional<Pose> pose(int frame, BodyIndex body) const {
    const BodyIndex there = other(body);
    return there.is_none() ? std::nullopt : tracks.pose(frame, there);
  }
  /// Where the vertices of a deformable body of this side are there; empty where that isn't known.
  std::vector<Vec3> surface(int frame, BodyIndex body) const {
    const BodyIndex there = other(body);
    return there.is_none() ? std::vector<Vec3>() : tracks.surface(frame, there);
  }
};

}  // namespace impinge
