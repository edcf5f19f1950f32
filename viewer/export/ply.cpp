// PLY, binary little-endian, doubles: Stanford's polygon format.
#include "engine/io/meshes/mesh_file.hpp"
#include "viewer/export/surface_sequence.hpp"

namespace impinge {

namespace {

class PlyExporter final : public SurfaceSequence {
 public:
  PlyExporter() : SurfaceSequence(".ply") {}

 private:
  void write(const std::filesystem::path& path, std::span<const Vec3> vertices,
             std::span<const Triangle> triangles) const override {
    write_ply(path, vertices, triangles);
  }
};

}  // namespace

Entry<Exporter> ply_exporter() {
  return entry<Exporter, PlyExporter>("ply", "surfaces, a file a body and frame, binary with doubles");
}

}  // namespace impinge
