#include "engine/io/scene/surface_keys.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/parameter.hpp"
#include "engine/geometry/mend/sheets.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/io/meshes/mesh_unit.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {
namespace {

constexpr double kMostScale = 1e6, kMostLength = 1e6;

int whole(const TomlNode& node, const std::string& what, int low, int high) {
  const double value = scene_real(node, what, {static_cast<double>(low), static_cast<double>(high)});
  if (value != std::floor(value))
    refuse(node.place, fmt::format("{} is {}", what, shortest(value)), "a whole number is wanted", "round it");
  return static_cast<int>(value);
}

Vec3 read_scale(const TomlNode& node, const std::string& what) {
  if (node.kind != TomlNode::array) return Vec3::Constant(scene_positive(node, what, kMostScale));
  const Vec3 scale = scene_vector(node, what, {0.0, kMostScale});
  if (!(scale.minCoeff() > 0.0))
    refuse(node.place, what + " has a zero", "three numbers greater than 0 are wanted", "change it");
  return scale;
}

std::optional<MendSettings> read_mend(const TomlNode& node, const std::string& what) {
  MendSettings settings;
  if (node.kind == TomlNode::boolean) return node.flag ? std::optional(settings) : std::nullopt;
  if (node.kind != TomlNode::table)
    refuse(node.place, fmt::format("{} is {}", what, toml_kind_name(node)), "true, false or a table is wanted",
           "write mend = true");
  check_keys(node, what,
             {"weld", "drop_degenerate", "orient", "fill_holes", "largest_hole", "thickness", "drop_inner", "remesh"});
  const auto with = [&](const char* key, auto&& read) {
    if (const TomlEntry* entry = node.find(key)) read(entry->value, fmt::format("{}.{}", what, key));
  };
  const auto flag = [&](const char* key, bool& to) {
    with(key, [&](const TomlNode& value, const std::string& name) { to = scene_flag(value, name); });
  };
  with("weld", [&](const TomlNode& value, const std::string& name) {
    settings.weld = scene_real(value, name, {0.0, kMostLength});
  });
  flag("drop_degenerate", settings.drop_degenerate);
  flag("orient", settings.orient);
  flag("fill_holes", settings.fill_holes);
  with("largest_hole", [&](const TomlNode& value, const std::string& name) {
    settings.largest_hole = scene_real(value, name, {0.0, 1e6});
  });
  with("thickness", [&](const TomlNode& value, const std::string& name) {
    settings.thickness = scene_positive(value, name, kMostLength);
  });
  flag("drop_inner", settings.drop_inner);
  with("remesh", [&](const TomlNode& value, const std::string& name) { settings.remesh = whole(value, name, 8, 400); });
  return settings;
}

}  // namespace

bool SurfaceKeys::is_plain() const {
  return !is_unit_given && !z_up && !component && !mend && !convex && !decimate && scale == Vec3::Constant(scale.x());
}

std::string SurfaceKeys::text() const {
  std::string text = fmt::format("{} {} {} {} {} {}", shortest(metres), z_up, shortest(scale.x()), shortest(scale.y()),
                                 shortest(scale.z()), component.value_or(0));
  if (mend)
    text += fmt::format(" mend {} {} {} {} {} {} {} {}", mend->weld ? shortest(*mend->weld) : "auto",
                        mend->drop_degenerate, mend->orient, mend->fill_holes, shortest(mend->largest_hole),
                        mend->thickness ? shortest(*mend->thickness) : "auto", mend->drop_inner, mend->remesh);
  if (decimate) text += fmt::format(" decimate {}", *decimate);
  return text;
}

SurfaceKeys SurfaceKeys::full() const {
  SurfaceKeys keys = *this;
  keys.decimate.reset();
  return keys;
}

const std::vector<std::string>& surface_keys() {
  static const std::vector<std::string> keys = {"mend", "unit", "up", "component", "convex", "decimate"};
  return keys;
}

SurfaceKeys read_surface_keys(const TomlNode& table, const std::string& what) {
  SurfaceKeys keys;
  const auto with = [&](const char* key, auto&& read) {
    if (const TomlEntry* entry = table.find(key)) read(entry->value, fmt::format("{}.{}", what, key));
  };
  with("scale", [&](const TomlNode& node, const std::string& name) { keys.scale = read_scale(node, name); });
  with("unit", [&](const TomlNode& node, const std::string& name) {
    const std::optional<double> metres = metres_of(scene_text(node, name));
    if (!metres)
      refuse(node.place, fmt::format("{} is {}", name, toml_string(node.string)),
             fmt::format("{} are allowed", unit_names()), "use one of them, or scale");
    keys.metres = *metres;
    keys.is_unit_given = true;
  });
  with("up", [&](const TomlNode& node, const std::string& name) {
    const std::string& word = scene_text(node, name);
    if (word != "y" && word != "z")
      refuse(node.place, fmt::format("{} is {}", name, toml_string(word)), "\"y\" or \"z\" is allowed",
             "use one of them, or rotation");
    keys.z_up = word == "z";
  });
  with("component",
       [&](const TomlNode& node, const std::string& name) { keys.component = whole(node, name, 1, 100'000'000); });
  with("convex", [&](const TomlNode& node, const std::string& name) { keys.convex = scene_flag(node, name); });
  with("decimate",
       [&](const TomlNode& node, const std::string& name) { keys.decimate = whole(node, name, 4, 100'000'000); });
  with("mend", [&](const TomlNode& node, const std::string& name) { keys.mend = read_mend(node, name); });
  return keys;
}

TriangleMesh placed(TriangleMesh mesh, const SurfaceKeys& keys, const TomlNode& table, const std::string& what) {
  for (Vec3& x : mesh.vertices) {
    x *= keys.metres;
    if (keys.z_up) x = Vec3(x.x(), x.z(), -x.y());
    x = x.cwiseProduct(keys.scale);
  }
  if (!keys.component) return mesh;
  // parts are connected where vertices coincide, as formats without shared vertices have them
  if (WeldedMesh welded = weld(mesh); !make_topology(mesh).is_closed()) mesh = std::move(welded.mesh);
  int count = 0;
  const std::vector<int> label = label_parts(mesh, make_topology(mesh), count);
  if (*keys.component > count)
    refuse(table.find("component")->value.place, fmt::format("{}.component is {}", what, *keys.component),
           fmt::format("the surface has {} connected part{}", count, count == 1 ? "" : "s"), "choose one of them");
  TriangleMesh part;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < label.size(); ++t) {
    if (label[t] != *keys.component - 1) continue;
    Triangle own = mesh.triangles[t];
    for (int& v : own) {
      if (index[v] < 0) index[v] = static_cast<int>(part.vertices.size()), part.vertices.push_back(mesh.vertices[v]);
      v = index[v];
    }
    part.triangles.push_back(own);
  }
  return part;
}

}  // namespace impinge
