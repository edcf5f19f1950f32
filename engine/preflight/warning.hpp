// What of a scene will hurt once it runs, told before it does: one kind of trouble a file, by a code that a scene can
// silence. A warning is no error: the scene runs, and whoever knows better is right.
#pragma once

#include "engine/io/scene/scene.hpp"
#include "engine/preflight/enclosure.hpp"
#include "engine/preflight/trial.hpp"

namespace impinge {

/// One place where a scene will hurt. Two halves of one sentence, `text: remedy`, without a full stop.
struct Finding {
  std::string text;    ///< what was found, where, with its number and what that was held against
  std::string remedy;  ///< what to do about it
};

/// A scene as loaded: frame 0 is published, nothing has moved.
struct SceneAtStart {
  const Scene& scene;
  const World& world;
  const ParameterSet& rows;
  std::vector<Enclosure> enclosures;
  const Trial* trial = nullptr;  ///< null: nobody tried
};

class Warning {
 public:
  virtual ~Warning() = default;
  /// The worst first; nothing where all is well.
  virtual std::vector<Finding> look(const SceneAtStart& start) const = 0;
};

/// All of them, in the order in which they are told.
const Registry<Warning>& warnings();

}  // namespace impinge
