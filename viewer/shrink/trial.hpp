// One attempt: a scene is run until a condition comes true, and what came of it is a bundle.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "viewer/bundle/bundle.hpp"
#include "viewer/shrink/small_scene.hpp"

namespace impinge {

struct Trial {
  SmallScene scene;
  int frame = 0;  ///< in which it became true
  std::size_t triangles = 0;
  BundleHead head;
  std::map<std::string, std::string> parts;  ///< of its bundle
};

class Trials {
 public:
  /// `folder`: where the scenes lie with the files that they read. `opening`: lines of the bundle's opening.script.
  Trials(std::filesystem::path folder, std::string condition, std::vector<std::string> opening);

  /// None where it doesn't come true by that frame, or the scene can't be made or leaves the finite numbers. Throws
  /// Interrupted.
  std::optional<Trial> run(const SmallScene& scene, int last_frame);
  /// The same of the bundle's own scene, where it has to. Throws InputError.
  Trial first(const std::filesystem::path& run_toml, int last_frame);
  /// What a bundle shows beside its states, which need not be run for: the frozen step, a picture, the state before.
  void complete(Trial& trial);
  /// The same scene from a later frame on; none where that can't be said in a scene.
  std::optional<SmallScene> begun_at(const SmallScene& scene, int frame);
  /// The same with a file of the state, which is that of its bodies and no others; none where a ramp is cut in two.
  std::optional<SmallScene> begun_with(const SmallScene& scene, int frame);

  /// With these bodies of the scene alone. Of a scene that begins with a state they begin as they do there, awake.
  std::optional<SmallScene> with_bodies(const SmallScene& scene, const std::vector<std::string>& names);
  /// The same without a body that a line adds.
  std::optional<SmallScene> without_added(const SmallScene& scene, const std::string& name);

  int tried() const { return tried_; }
  std::filesystem::path folder() const { return folder_; }

 private:
  std::unique_ptr<Session> load(const SmallScene& scene);
  std::optional<SmallScene> with_state_of(const SmallScene& scene, const SmallScene& less);
  std::optional<Trial> run(Session& session, const SmallScene& scene, int last_frame);

  std::filesystem::path folder_;
  std::string condition_;
  std::vector<std::string> opening_;
  int tried_ = 0, states_ = 0;
};

}  // namespace impinge
