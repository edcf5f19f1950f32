// A step record put together by hand: what the view draws, without a simulation behind it.
#pragma once

#include <deque>
#include <functional>
#include <string>

#include "engine/shapes/primitives.hpp"
#include "engine/world/step_record.hpp"

namespace impinge::test {

class HandMadeRecord {
 public:
  HandMadeRecord() {
    record_.gravity = {0.0, -9.81, 0.0};
    record_.frame_time = 1.0 / 60.0;
    record_.stats.substeps = 1;
  }
  HandMadeRecord(const HandMadeRecord&) = delete;
  HandMadeRecord& operator=(const HandMadeRecord&) = delete;

  /// Returns the body's index. Stays valid for ever: bodies are never moved.
  int add(const std::string& name, BodyKind kind, SharedShape shape, const Vec3& position,
          const Mat3& rotation = Mat3::Identity()) {
    names_.push_back(name);
    shapes_.push_back(std::move(shape));
    vertices_.emplace_back();
    BodyRecord body;
    body.name = names_.back();
    body.kind = kind;
    body.shape = shapes_.back().get();
    body.pose = body.file_pose = {rotation, position};
    body.mass = kind == BodyKind::dynamic ? 1.0 : 0.0;
    if (const SurfaceMesh* mesh = body.shape->mesh()) {
      for (const Vec3& v : mesh->mesh.vertices) vertices_.back().push_back(body.pose.apply(v));
      body.vertices = vertices_.back();
      for (const Vec3& v : vertices_.back()) body.bounds.include(v);
    } else {
      body.bounds = body.shape->bounds(body.pose);
    }
    record_.bodies.push_back(body);
    record_.stats.bodies = static_cast<int>(record_.bodies.size());
    return record_.stats.bodies - 1;
  }

  /// A deformable body: node positions are `place` of the rest positions, velocities likewise; `held` are held nodes.
  int add_soft(const std::string& name, const MeshPointer& surface, const TetMesh& mesh, const Embedding& embedding,
               const std::function<Vec3(const Vec3&)>& place, const std::vector<int>& held = {},
               std::string_view material = "corotational") {
    std::shared_ptr<Material> elastic = find_entry(materials(), material)->make();
    DeformableBody& soft = soft_.emplace_back(FemAssembly(mesh, {{elastic, 1000.0}}, MassKind::lumped));
    soft.hold(held);
    for (int i = 0; i < soft.nodes(); ++i)
      soft.position.segment<3>(3 * i) = place(mesh.vertices[static_cast<std::size_t>(i)]);
    soft.embedding = embedding;
    const int index = add(name, BodyKind::deformable, surface, Vec3::Zero());
    BodyRecord& body = record_.bodies.back();
    body.deformable = &soft;
    interpolate(embedding, mesh, soft.position, vertices_.back());
    body.vertices = vertices_.back();
    body.bounds = Aabb{};
    for (const Vec3& v : vertices_.back()) body.bounds.include(v);
    body.pose.position = body.file_pose.position = soft.center_of_mass();
    body.mass = soft.fem.total_mass();
    return index;
  }
  DeformableBody& last_soft() { return soft_.back(); }

  ContactRecord& touch(int a, int b, const Vec3& point, const Vec3& normal, ContactState state, double gap = 0.0) {
    ContactRecord contact;
    contact.body_a = BodyIndex(a), contact.body_b = BodyIndex(b);
    contact.point_b = point;
    contact.point_a = point + gap * normal;
    contact.normal = normal;
    contact.gap = contact.gap0 = gap;
    contact.state = state;
    contact.friction = 0.4;
    record_.contacts.push_back(contact);
    record_.stats.contacts = static_cast<std::int64_t>(record_.contacts.size());
    return record_.contacts.back();
  }

  StepRecord& record() { return record_; }
  const StepRecord& record() const { return record_; }

 private:
  std::deque<std::string> names_;
  std::deque<SharedShape> shapes_;
  std::deque<std::vector<Vec3>> vertices_;
  std::deque<DeformableBody> soft_;
  StepRecord record_;
};

}  // namespace impinge::test
