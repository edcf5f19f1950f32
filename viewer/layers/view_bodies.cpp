#include "viewer/layers/view_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/parameter.hpp"
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

std::string unknown_body(const StepRecord& record, const ViewSettings& settings) {
  std::vector<std::string> bodies;
  for (const BodyRecord& body : record.bodies) bodies.emplace_back(body.name);
  const auto wrong = [&](const char* path, const std::string& name) -> std::string {
    if (name.empty() || std::find(bodies.begin(), bodies.end(), name) != bodies.end()) return "";
    const std::string near = nearest_word(name, bodies);
    return fmt::format("'{}' for {}; bodies: {}; {}", name, path, some_of(bodies),
                       near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
  };
  for (const auto& [path, names] : {std::pair("view.hidden", settings.hidden), {"view.locked", settings.locked}})
    for (const std::string& name : names)
      if (std::string text = wrong(path, name); !text.empty()) return text;
  for (const std::string& entry : settings.colors) {
    if (std::string text = wrong("view.colors", std::string(name_in(entry))); !text.empty()) return text;
    if (!color_in(entry))
      return fmt::format("'{}' for view.colors; NAME=rrggbb is wanted; write \"{}=e07020\", say", entry,
                         name_in(entry));
  }
  return wrong("view.camera.follow", settings.followed);
}

}  // namespace impinge
