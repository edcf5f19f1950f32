// What a view says of single bodies: which are left out of the picture, and which one the camera goes along with.
#pragma once

#include <vector>

#include "engine/world/step_record.hpp"
#include "viewer/draw/draw_list.hpp"
#include "viewer/draw/view_settings.hpp"

namespace impinge {

/// Bodies of a record by a list of names, asked by index or by what was picked.
class BodySet {
 public:
  BodySet(const StepRecord& record, const std::vector<std::string>& names);
  bool is_empty() const { return none_; }
  void add(std::size_t body) { in_[body] = true, none_ = false; }
  bool has(BodyIndex body) const { return in_[static_cast<std::size_t>(body.value())]; }
  /// A contact belongs to it if both its bodies do.
  bool has(PickId pick) const;

 private:
  const StepRecord& record_;
  std::vector<bool> in_;
  bool none_ = true;
};

/// What is in no picture: bodies that are hidden, and those that are deleted.
BodySet not_drawn(const StepRecord& record, const ViewSettings& settings);

/// The centre of the body that the camera follows, the origin if it follows none.
Vec3 camera_origin(const StepRecord& record, const ViewSettings& settings);
/// In the world's coordinates, whatever it follows.
Camera camera_in_world(const StepRecord& record, const ViewSettings& settings);

/// The same, back so far that a picture of that aspect has all that view.camera.fit wants in it.
Camera camera_of_picture(const StepRecord& record, const ViewSettings& settings, double aspect);

/// Throws SettingsError at the first name of a body that isn't there, or colour that is none.
void check_names(const StepRecord& record, const ViewSettings& settings);

}  // namespace impinge
