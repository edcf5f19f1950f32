#include "viewer/controller/surface_export.hpp"

#include "engine/io/meshes/mesh_file.hpp"
#include "viewer/draw/tessellation.hpp"

namespace impinge {

void export_surfaces(const std::filesystem::path& folder, const StepRecord& record) {
  for (const BodyRecord& body : record.bodies) {
    if (std::holds_alternative<Plane>(*body.shape)) continue;
    const std::filesystem::path path = folder / (std::string(body.name) + ".ply");
    if (const auto* mesh = std::get_if<MeshPointer>(body.shape)) {
      write_ply(path, body.vertices, (*mesh)->mesh.triangles);
    } else {
      TriangleMesh surface = tessellate(*body.shape);
      for (Vec3& x : surface.vertices) x = body.pose.apply(x);
      write_ply(path, surface.vertices, surface.triangles);
    }
  }
}

}  // namespace impinge
