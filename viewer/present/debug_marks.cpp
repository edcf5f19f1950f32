#include "viewer/present/debug_marks.hpp"

#include <algorithm>

#include "engine/shapes/primitives.hpp"
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/pull_mark.hpp"
#include "viewer/panels/debug/outliner.hpp"

namespace impinge {
namespace {

constexpr Color kSelected = hex(0xfff2a8);
constexpr Color kAgainst = hex(0xff4fd8);  // bodies of what is made beside the scene
constexpr float kTrailWidth = 1.6f;
constexpr double kKept = 1e-6;  // of a body's size: what places that are kept in single precision may be off by
constexpr double kAsked = 0.6;  // of the size of a pull that acts

std::vector<BodyIndex> trailed(const DebugModel& model) {
  std::vector<BodyIndex> bodies = selected_bodies(model);
  std::erase_if(bodies, [&](BodyIndex b) {
    const BodyRecord& body = model.record->bodies[static_cast<std::size_t>(b.value())];
    return body.kind == BodyKind::fixed || body.deleted;
  });
  if (bodies.empty() && !model.selection.is_there())
    for (std::size_t i = 0; i < model.record->bodies.size(); ++i)
      if (model.record->bodies[i].kind != BodyKind::fixed && !model.record->bodies[i].deleted)
        bodies.push_back(BodyIndex(i));
  return bodies;
}

}  // namespace

Aabb bounds_of_selection(const DebugModel& model) {
  Aabb box;
  const Selection& s = model.selection;
  if (!s.is_there()) return box;
  if (s.kind == Selection::contact) {
    const ContactRecord& c = model.record->contacts[static_cast<std::size_t>(s.index)];
    box.include(c.point_a);
    box.include(c.point_b);
    return box;
  }
  const BodyRecord& body = model.record->bodies[static_cast<std::size_t>(s.index)];
  if (body.deleted) return box;
  return body.shape->as<Plane>() == nullptr ? body.bounds : box;
}

void mark_selection(const DebugModel& model, DrawList& list) {
  const Selection& s = model.selection;
  if (!s.is_there()) return;
  if (s.kind == Selection::contact) {
    const ContactRecord& c = model.record->contacts[static_cast<std::size_t>(s.index)];
    list.points.push_back({c.point_a, kSelected, 17.0f, Depth::on_top});
    list.points.push_back({c.point_a, hex(0x20242a), 9.0f, Depth::on_top});
    list.arrows.push_back({c.point_a, c.normal, kSelected, 60.0f, 3.5f, Depth::on_top});
    return;
  }
  const BodyRecord& body = model.record->bodies[static_cast<std::size_t>(s.index)];
  if (body.deleted) return;
  if (!body.bounds.is_empty() && body.shape->as<Plane>() == nullptr)
    list.add_box({}, body.bounds.min, body.bounds.max, kSelected, 2.0f, Depth::both, 0);
  const SurfaceMesh* mesh = body.shape->mesh();
  if (mesh == nullptr || s.triangle < 0 || s.triangle >= static_cast<int>(mesh->mesh.triangles.size())) return;
  const auto& t = mesh->mesh.triangles[static_cast<std::size_t>(s.triangle)];
  list.triangles.push_back(
      {{body.vertices[static_cast<std::size_t>(t[0])], body.vertices[static_cast<std::size_t>(t[1])],
        body.vertices[static_cast<std::size_t>(t[2])]},
       kSelected,
       Depth::on_top});
}

void mark_pulls(const DebugModel& model, DrawList& list) {
  if (!model.view->is_on("pulls"))  // a hand must see what it does, whatever layers the scene wants
    for (std::size_t i = 0; i < model.record->bodies.size(); ++i)
      if (const auto& pull = model.record->bodies[i].pull)
        mark_pull(pull->point, pull->target, *model.view, 1.0, body_pick(i), list);
  for (const Act& act : model.asked) {
    if (act.verb != Act::pull) continue;
    for (std::size_t i = 0; i < model.record->bodies.size(); ++i) {
      const BodyRecord& body = model.record->bodies[i];
      if (body.name != act.body || body.deleted) continue;
      const Vec3 point = body.deformable != nullptr
                             ? body.deformable->position_of(body.deformable->own_point(*act.point))
                             : body.file_pose.apply(*act.point);
      mark_pull(point, act.vector, *model.view, kAsked, body_pick(i), list);
    }
  }
}

void draw_trails(const DebugModel& model, DrawList& list) {
  if (!model.state.trails) return;
  const std::vector<Color> colors = body_colors(*model.record, model.view->colors);
  for (const BodyIndex body : trailed(model)) {
    const Color color = colors[static_cast<std::size_t>(body.value())];
    std::optional<Pose> before;
    for (int frame = model.tracks->first(); frame <= model.frame; ++frame) {
      const std::optional<Pose> now = model.tracks->pose(frame, body);
      if (before && now) list.lines.push_back({before->position, now->position, color, kTrailWidth, Depth::both, 0});
      if (now) list.points.push_back({now->position, color, 2.0f * kTrailWidth, Depth::both, 0});
      before = now;
    }
  }
}

namespace {

DrawSurface ghost_of(const DrawSurface& item, Color color) {
  DrawSurface ghost = item;
  ghost.see_through = true;
  ghost.faintness = 0.75f;
  ghost.color = color;
  ghost.heat = nullptr;
  ghost.pick = 0;
  return ghost;
}

/// Of what is made beside it a body, where that is elsewhere.
void draw_against(const DebugModel& model, std::size_t item, BodyIndex body, DrawList& list) {
  const DrawSurface& drawn = list.surfaces[item];
  const BodyRecord& now = model.record->bodies[static_cast<std::size_t>(body.value())];
  const std::optional<Pose> there = model.against->pose(model.frame, body);
  if (!there) return;
  DrawSurface ghost = ghost_of(drawn, kAgainst);
  if (drawn.moved == nullptr) {
    if (there->position == now.pose.position && there->rotation == now.pose.rotation) return;
    ghost.pose = *there;
  } else {
    const std::vector<Vec3> vertices = model.against->surface(model.frame, body);
    const double kept = kKept * now.bounds.extent().norm();
    const auto is_same = [&](const Vec3& a, const Vec3& b) { return (a - b).norm() <= kept; };
    if (vertices.size() != now.vertices.size() ||
        std::equal(vertices.begin(), vertices.end(), now.vertices.begin(), is_same))
      return;
    ghost.moved = std::make_shared<const MovedSurface>(move_surface(*drawn.surface, vertices, false));
  }
  list.surfaces.push_back(std::move(ghost));
}

}  // namespace

void draw_coming(const DebugModel& model, DrawList& list) {
  const std::size_t surfaces = list.surfaces.size();
  for (const DebugModel::Coming& coming : model.coming)
    for (std::size_t i = 0; i < surfaces; ++i) {
      const DrawSurface& item = list.surfaces[i];
      if (item.pick == 0 || item.pick > model.record->bodies.size()) continue;
      if (model.record->bodies[item.pick - 1].name != coming.like) continue;
      DrawSurface ghost = ghost_of(item, item.color);
      ghost.pose = coming.body.pose;
      if (item.moved != nullptr)
        ghost.moved = std::make_shared<const MovedSurface>(move_surface(*item.surface, coming.body.vertices, false));
      list.surfaces.push_back(std::move(ghost));
    }
}

void draw_ghost(const DebugModel& model, DrawList& list) {
  const std::size_t surfaces = list.surfaces.size();
  for (std::size_t i = 0; i < surfaces; ++i) {
    const DrawSurface& item = list.surfaces[i];
    if (item.pick == 0 || item.pick > model.record->bodies.size()) continue;
    const BodyIndex body(item.pick - 1);
    if (model.record->bodies[item.pick - 1].kind == BodyKind::fixed) continue;
    const std::optional<Pose> before =
        model.state.ghost >= 0 && item.moved == nullptr ? model.tracks->pose(model.state.ghost, body) : std::nullopt;
    if (before) {
      DrawSurface ghost = ghost_of(item, item.color);
      ghost.pose = *before;
      list.surfaces.push_back(std::move(ghost));
    }
    if (model.against != nullptr) draw_against(model, i, body, list);
  }
}

}  // namespace impinge
