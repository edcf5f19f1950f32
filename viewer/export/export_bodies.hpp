// What of the bodies goes into files: a surface each, but for planes, which have no end.
#pragma once

#include <memory>
#include <optional>

#include "engine/geometry/triangle_mesh.hpp"
#include "engine/world/step_record.hpp"
#include "viewer/draw/palette.hpp"

namespace impinge {

struct ExportBody {
  BodyIndex body;
  std::string name;
  BodyKind kind = BodyKind::dynamic;
  /// Of a body with a pose: in the frame of its file, or of its shape, so that file_pose brings it into the world;
  /// shared by bodies of one shape. Of a deformable body: where it stood at the start, in the world.
  std::shared_ptr<const TriangleMesh> surface;
  /// In the same frame: where single precision counts from. Zero, unless the surface lies far from there for its size.
  Vec3 origin = Vec3::Zero();
  Color color;
  Pose start = {};  ///< its file_pose then

  bool is_static() const { return kind == BodyKind::fixed; }
  bool is_deformable() const { return kind == BodyKind::deformable; }
};

/// Whether what is drawn and exported has other triangles than what takes part in contact (SurfaceMesh::full).
bool is_shown_apart(const Shape& shape);

/// In the scene's order. `colors`: entries of view.colors.
std::vector<ExportBody> export_bodies(const StepRecord& start, const std::vector<std::string>& colors);

/// Null while it is not added yet, or deleted.
const BodyRecord* there(const ExportBody& body, const StepRecord& record);

/// The vertices of its surface in the world.
std::vector<Vec3> world_surface(const ExportBody& body, const StepRecord& record);

/// For formats that have single precision for vertices and more for where they are: the surface from its origin, and
/// what brings it into the world.
std::vector<Vec3> local_surface(const ExportBody& body, const StepRecord& record);
Pose local_pose(const ExportBody& body, const StepRecord& record);

/// The same as it started, or will when it is added.
std::vector<Vec3> start_surface(const ExportBody& body);
Pose start_pose(const ExportBody& body);

/// The middle of the box if that is so far from zero that single precision would not tell its points apart; else zero.
Vec3 far_origin(const Aabb& box);

/// The rotation as a unit quaternion, of the two that there are the one nearer to `before`.
Quat quaternion_of(const Mat3& rotation, const std::optional<Quat>& before);

/// The box round all surfaces.
Aabb bounds_of(const std::vector<ExportBody>& bodies, const StepRecord& record);

/// Light as it adds up (glTF, USD), not as it is shown.
Vec3 linear_color(const Color& color);

}  // namespace impinge
