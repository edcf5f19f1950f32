// Wavefront OBJ: text, every number in the shortest form that reads back exactly.
#include <fmt/compile.h>
#include <fmt/format.h>

#include "engine/io/file.hpp"
#include "viewer/export/surface_sequence.hpp"

namespace impinge {

namespace {

class ObjExporter final : public SurfaceSequence {
 public:
  ObjExporter() : SurfaceSequence(".obj") {}

 private:
  void write(const std::filesystem::path& path, std::span<const Vec3> vertices,
             std::span<const Triangle> triangles) const override {
    fmt::memory_buffer text;
    const auto to = fmt::appender(text);
    for (const Vec3& x : vertices) fmt::format_to(to, FMT_COMPILE("v {} {} {}\n"), x.x(), x.y(), x.z());
    for (const Triangle& t : triangles) fmt::format_to(to, FMT_COMPILE("f {} {} {}\n"), t[0] + 1, t[1] + 1, t[2] + 1);
    write_file(path, {text.data(), text.size()});
  }
};

}  // namespace

Entry<Exporter> obj_exporter() { return entry<Exporter, ObjExporter>("obj", "the same as text"); }

}  // namespace impinge
