// A scene with its script as something that parts can be taken from, each time leaving a scene that stands by itself.
#pragma once

#include <map>

#include "engine/world/step_record.hpp"
#include "viewer/controller/session.hpp"

namespace impinge {

struct SmallScene {
  Scene scene;                      ///< bodies, attachments, surfaces
  RunRecord run;                    ///< the script's lines among it
  ParameterSet rows;                ///< before frame 0
  std::set<std::string> gone = {};  ///< bodies that were taken out

  /// As it was before frame 0. Lines that neither a state nor a picture depends on are left out.
  explicit SmallScene(const Session& session);
  std::string run_toml() const;

  std::vector<std::string> bodies() const;  ///< names
  /// With these bodies alone; what speaks of the others goes with them: attachments, lines of the script.
  SmallScene with_bodies(const std::vector<std::string>& names) const;
  SmallScene without(const std::set<std::string>& bodies) const;
  std::vector<std::string> added() const;               ///< names of bodies that lines add
  std::vector<std::string> additions_at_start() const;  ///< the lines that do so in frame 0
  SmallScene with_attachments(const std::vector<std::size_t>& places) const;
  SmallScene with_lines(const std::vector<std::string>& lines) const;
  /// Begins where `record` is, after so many frames; `start`: where the bodies' files were before them. None where the
  /// scene can't say that: bodies that deform, and a ramp that is cut in two.
  std::optional<SmallScene> begun_at(int frame, const StepRecord& record, const std::vector<Pose>& start) const;
  /// Begins with a state, that of its frame. None where a ramp is cut in two.
  std::optional<SmallScene> begun_with(int frame, const std::string& state) const;
  /// Begins with another state, whose time is 0: what is moved by its scene does sooner by `time` what it does later.
  SmallScene begun_anew(double time, const StepRecord& record, const std::string& state) const;
  /// With another file in place of a surface.
  SmallScene with_surface(const std::string& name, const std::string& other) const;
};

}  // namespace impinge
