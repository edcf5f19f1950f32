// What pictures of a scene will not show: warnings that the model can't know of (engine/preflight/warning.hpp).
#pragma once

#include "engine/preflight/warning.hpp"
#include "viewer/draw/view_settings.hpp"

namespace impinge {

/// The view of frame 0, its camera settled.
struct ViewAtStart {
  const World& world;
  const ViewSettings& settings;
  bool camera_given = false;       ///< by the scene; else it was fitted
  int width = 1280, height = 720;  ///< pixels
};

class ViewWarning {
 public:
  virtual ~ViewWarning() = default;
  /// The worst first; nothing where all is well.
  virtual std::vector<Finding> look(const ViewAtStart& start) const = 0;
};

const Registry<ViewWarning>& view_warnings();

}  // namespace impinge
