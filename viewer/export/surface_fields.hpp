// What a frame's contacts do to the vertices of surfaces.
#pragma once

#include <map>
#include <memory>

#include "engine/geometry/box_tree.hpp"
#include "viewer/export/export_bodies.hpp"

namespace impinge {

/// On one surface, by vertex.
struct ContactField {
  /// N·s, of the last sub-step, on this body: a contact's is shared by the corners of its triangle, in the shares that
  /// give its point back, so that the sum over vertices is the sum over contacts.
  std::vector<Vec3> impulse;
  std::vector<double> gap;  ///< metres, the smallest of the contacts at the vertex; not a number where there is none
};

class ContactFields {
 public:
  /// In the order of `bodies`; `vertices` are their surfaces in the world.
  std::vector<ContactField> find(const std::vector<ExportBody>& bodies, const std::vector<std::vector<Vec3>>& vertices,
                                 const StepRecord& record);

 private:
  int triangle_at(const ExportBody& body, const BodyRecord& now, const Vec3& point);

  std::map<const TriangleMesh*, BoxTree> trees_;  // of exact shapes, whose contacts name no triangle
};

/// The contact's impulse on A in the world, N·s.
Vec3 world_impulse(const ContactRecord& contact);

}  // namespace impinge
