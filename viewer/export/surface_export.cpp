#include "viewer/export/surface_export.hpp"

#include "engine/io/meshes/mesh_file.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {

void export_surfaces(const std::filesystem::path& folder, const StepRecord& record) {
  for (const BodyRecord& body : record.bodies) {
    if (body.deleted || body.shape->as<Plane>() != nullptr) continue;  // a plane is without end
    const std::filesystem::path path = folder / (std::string(body.name) + ".ply");
    if (const SurfaceMesh* mesh = body.shape->mesh(); mesh != nullptr && mesh->full == nullptr) {
      write_ply(path, body.vertices, mesh->mesh.triangles);
    } else {
      TriangleMesh surface = body.shape->drawn();
      for (Vec3& x : surface.vertices) x = body.pose.apply(x);
      write_ply(path, surface.vertices, surface.triangles);
    }
  }
}

}  // namespace impinge
