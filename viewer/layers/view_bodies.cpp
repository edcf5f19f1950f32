#include "viewer/layers/view_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/parameter.hpp"
#include "engine/core/settings_error.hpp"
#include "viewer/draw/body_color.hpp"

namespace impinge {

BodySet::BodySet(const StepRecord& record, const std::vector<std::string>& names)
    : record_(record), in_(record.bodies.size(), false) {
  if (names.empty()) return;
  for (std::size_t i = 0; i < in_.size(); ++i) {
    if (std::find(names.begin(), names.end(), record.bodies[i].name) != names.end()) add(i);
  }
}

bool BodySet::has(PickId pick) const {
  if (none_ || pick == 0) return false;
  if (const std::size_t contact = pick & ~contact_pick(0); pick != contact) {
    const ContactRecord& c = record_.contacts[contact];
    return has(c.body_a) && has(c.body_b);
  }
  return pick <= in_.size() && in_[pick - 1];
}

BodySet not_drawn(const StepRecord& record, const ViewSettings& settings) {
  BodySet set(record, settings.hidden);
  for (std::size_t i = 0; i < record.bodies.size(); ++i)
    if (record.bodies[i].deleted) set.add(i);
  return set;
}

Vec3 camera_origin(const StepRecord& record, const ViewSettings& settings) {
  if (!settings.followed.empty())
    for (const BodyRecord& body : record.bodies)
      if (body.name == settings.followed) return body.pose.position;
  return Vec3::Zero();
}

Camera camera_in_world(const StepRecord& record, const ViewSettings& settings) {
  Camera camera = settings.camera;
  if (settings.followed.empty()) return camera;
  const Vec3 origin = camera_origin(record, settings);
  camera.eye += origin;
  camera.target += origin;
  return camera;
}

Camera camera_of_picture(const StepRecord& record, const ViewSettings& settings, double aspect) {
  Camera camera = camera_in_world(record, settings);
  if (settings.camera_fit == CameraFit::start) return camera;
  const BodySet left_out = not_drawn(record, settings);
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const BodyRecord& body = record.bodies[i];
    if (body.kind == BodyKind::fixed || body.bounds.is_empty() || left_out.has(BodyIndex(static_cast<int>(i))))
      continue;
    for (int bits = 0; bits < 8; ++bits)
      corners.emplace_back(bits & 1 ? body.bounds.max.x() : body.bounds.min.x(),
                           bits & 2 ? body.bounds.max.y() : body.bounds.min.y(),
                           bits & 4 ? body.bounds.max.z() : body.bounds.min.z());
  }
  camera.take_in(corners, aspect);
  return camera;
}

void check_names(const StepRecord& record, const ViewSettings& settings) {
  std::vector<std::string> bodies;
  for (const BodyRecord& body : record.bodies) bodies.emplace_back(body.name);
  const auto check = [&](const char* path, const std::string& name) {
    if (name.empty() || std::find(bodies.begin(), bodies.end(), name) != bodies.end()) return;
    const std::string near = nearest_word(name, bodies);
    throw SettingsError({path},
                        fmt::format("'{}' for {}; bodies: {}; {}", name, path, some_of(bodies),
                                    near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near)));
  };
  for (const std::string& name : settings.hidden) check("view.hidden", name);
  for (const std::string& name : settings.locked) check("view.locked", name);
  for (const std::string& entry : settings.colors) {
    check("view.colors", std::string(name_in(entry)));
    if (!color_in(entry))
      throw SettingsError(
          {"view.colors"},
          fmt::format("'{}' for view.colors; NAME=rrggbb is wanted; write \"{}=e07020\", say", entry, name_in(entry)));
  }
  check("view.camera.follow", settings.followed);
}

}  // namespace impinge
