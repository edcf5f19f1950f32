// glTF read by tinygltf: what a viewer shows at each key frame is the run's surface.
#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "engine/core/types.hpp"
#include "engine/geometry/aabb.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "engine/io/meshes/tinygltf.hpp"
#include "tests/support/program/export_scene.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

class Glb {
 public:
  explicit Glb(const fs::path& path) {
    tinygltf::TinyGLTF loader;
    std::string error, warning;
    const bool read = loader.LoadBinaryFromFile(&model_, &error, &warning, path.string());
    INFO(error << warning);
    REQUIRE(read);
    CHECK(error.empty());
    CHECK(warning.empty());
    REQUIRE(model_.scenes.size() == 1);
    REQUIRE(model_.scenes[0].nodes.size() == 1);
    for (std::size_t i = 0; i < model_.accessors.size(); ++i) check_accessor(static_cast<int>(i));
    if (model_.animations.empty()) return;
    REQUIRE(model_.animations.size() == 1);
    for (const auto& channel : model_.animations[0].channels) {
      const auto& sampler = model_.animations[0].samplers.at(static_cast<std::size_t>(channel.sampler));
      CHECK(sampler.interpolation == (channel.target_path == "scale" ? "STEP" : "LINEAR"));
      times = numbers(sampler.input);
    }
  }

  std::vector<float> times;

  std::set<std::string> bodies() const {
    std::set<std::string> names;
    for (const int child : root().children) names.insert(node(child).name);
    return names;
  }
  bool is_animated(const std::string& body) const { return !channels(index(body)).empty(); }
  std::size_t accessors() const { return model_.accessors.size(); }
  int vertices_of(const std::string& body) const { return primitive(index(body)).attributes.at("POSITION"); }
  std::vector<Triangle> triangles(const std::string& body) const {
    const auto& accessor = model_.accessors.at(static_cast<std::size_t>(primitive(index(body)).indices));
    REQUIRE(accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    std::vector<Triangle> all(accessor.count / 3);
    std::memcpy(all.data(), data(accessor), accessor.count * 4);
    return all;
  }

  /// In the world at a key frame, by the rules of the format, in doubles.
  std::vector<Vec3> surface(const std::string& body, std::size_t key) const {
    const int n = index(body);
    const auto& shape = primitive(n);
    std::vector<Vec3> points = vectors(shape.attributes.at("POSITION"));
    std::vector<double> weights = mesh(n).weights;
    Vec3 place = vector(node(n).translation);
    Quat turn = quaternion(node(n).rotation);
    Vec3 scale = node(n).scale.empty() ? Vec3(1, 1, 1) : vector(node(n).scale);
    for (const auto& [path, output] : channels(n)) {
      const std::vector<float> values = numbers(output);
      const std::size_t width = values.size() / times.size();
      REQUIRE(values.size() == width * times.size());
      const std::vector<double> now(values.begin() + static_cast<std::ptrdiff_t>(width * key),
                                    values.begin() + static_cast<std::ptrdiff_t>(width * (key + 1)));
      if (path == "translation") place = vector(now);
      if (path == "rotation") turn = quaternion(now);
      if (path == "weights") weights = now;
      if (path == "scale") scale = vector(now);
    }
    REQUIRE(weights.size() == shape.targets.size());
    for (std::size_t t = 0; t < weights.size(); ++t) {
      const std::vector<Vec3> moved = vectors(shape.targets[t].at("POSITION"));
      REQUIRE(moved.size() == points.size());
      for (std::size_t v = 0; v < points.size(); ++v) points[v] += weights[t] * moved[v];
    }
    CHECK(std::abs(turn.norm() - 1.0) < 1e-6);
    for (Vec3& x : points) x = vector(root().translation) + place + turn.normalized() * scale.cwiseProduct(x);
    return points;
  }

 private:
  static Vec3 vector(const std::vector<double>& v) {
    return v.empty() ? Vec3(0, 0, 0) : Vec3(v.at(0), v.at(1), v.at(2));
  }
  static Quat quaternion(const std::vector<double>& q) {
    return q.empty() ? Quat::Identity() : Quat(q.at(3), q.at(0), q.at(1), q.at(2));
  }
  const tinygltf::Node& node(int n) const { return model_.nodes.at(static_cast<std::size_t>(n)); }
  const tinygltf::Node& root() const { return node(model_.scenes[0].nodes[0]); }
  const tinygltf::Mesh& mesh(int n) const { return model_.meshes.at(static_cast<std::size_t>(node(n).mesh)); }
  const tinygltf::Primitive& primitive(int n) const { return mesh(n).primitives.at(0); }
  int index(const std::string& body) const {
    for (const int child : root().children)
      if (node(child).name == body) return child;
    FAIL("no node " << body);
    return -1;
  }
  std::vector<std::pair<std::string, int>> channels(int n) const {
    std::vector<std::pair<std::string, int>> found;
    if (model_.animations.empty()) return found;
    for (const auto& channel : model_.animations[0].channels)
      if (channel.target_node == n)
        found.emplace_back(channel.target_path,
                           model_.animations[0].samplers.at(static_cast<std::size_t>(channel.sampler)).output);
    return found;
  }
  const unsigned char* data(const tinygltf::Accessor& accessor) const {
    const auto& view = model_.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
    return model_.buffers.at(0).data.data() + view.byteOffset + accessor.byteOffset;
  }
  std::vector<float> numbers(int index) const {
    const auto& accessor = model_.accessors.at(static_cast<std::size_t>(index));
    REQUIRE(accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT);
    const auto size =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    std::vector<float> all(accessor.count * size);
    std::memcpy(all.data(), data(accessor), all.size() * 4);
    return all;
  }
  std::vector<Vec3> vectors(int index) const {
    const std::vector<float> values = numbers(index);
    std::vector<Vec3> all(values.size() / 3);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return all;
  }
  /// Within its view and the buffer, at a multiple of four, and its bounds are its numbers'.
  void check_accessor(int index) const {
    const auto& accessor = model_.accessors.at(static_cast<std::size_t>(index));
    const auto& view = model_.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
    const auto size =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    CHECK(accessor.count > 0);
    CHECK(view.byteOffset % 4 == 0);
    CHECK(accessor.count * size * 4 == view.byteLength);
    CHECK(view.byteOffset + view.byteLength <= model_.buffers.at(0).data.size());
    if (accessor.minValues.empty()) return;
    const std::vector<float> values = numbers(index);
    for (std::size_t k = 0; k < size; ++k) {
      float low = values[k], high = low;
      for (std::size_t i = k; i < values.size(); i += size)
        low = std::min(low, values[i]), high = std::max(high, values[i]);
      CHECK(static_cast<float>(accessor.minValues.at(k)) == low);
      CHECK(static_cast<float>(accessor.maxValues.at(k)) == high);
    }
  }

  tinygltf::Model model_;
};

void check_glb(const Glb& glb, const fs::path& run, const std::vector<int>& frames, double frame_time) {
  REQUIRE(glb.times.size() == frames.size());
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(run / "surfaces/000000")) names.insert(entry.path().stem().string());
  CHECK(glb.bodies() == names);
  double worst = 0.0;
  Aabb box;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    CHECK(std::abs(glb.times[k] - frames[k] * frame_time) < 1e-6 * std::max(1.0, frames[k] * frame_time));
    for (const std::string& name : names) {
      const TriangleMesh truth = read_mesh(run / fmt::format("surfaces/{:06}/{}.ply", frames[k], name));
      CHECK(glb.triangles(name) == truth.triangles);
      const std::vector<Vec3> shown = glb.surface(name, k);
      REQUIRE(shown.size() == truth.vertices.size());
      for (std::size_t v = 0; v < shown.size(); ++v) {
        worst = std::max(worst, (shown[v] - truth.vertices[v]).cwiseAbs().maxCoeff());
        if (k == 0) box.include(truth.vertices[v]);
      }
    }
  }
  CHECK(worst < 1e-6 * box.extent().norm());
}

}  // namespace

TEST_CASE("a glTF shows the run's surfaces at the run's times, to 1e-6 of the scene's size") {
  const double shift = GENERATE(0.0, 3e4);
  const TempFolder folder;
  REQUIRE(export_run(folder, export_scene(shift)).code == 0);
  REQUIRE(impinge_run(folder.path(), {"export", "out", "--format", "gltf", "--frames", "0:12:2"}).code == 0);
  const Glb glb(folder / "out/export/s.glb");
  check_glb(glb, folder / "out", {0, 2, 4, 6, 8, 10, 12}, 0.0166666666667);
  CHECK(!glb.is_animated("wall"));
  CHECK(glb.is_animated("paddle"));
  CHECK(glb.is_animated("jelly"));
  // one mesh, two bodies: its numbers are there once
  CHECK(glb.vertices_of("tetra-1") == glb.vertices_of("tetra_1"));
}

TEST_CASE("a body that is added or deleted has no size in a glTF while it isn't there") {
  const TempFolder folder;
  folder.write("change.script",
               "at 4 add jelly_2 like jelly at 0.1 2 0.3\nat 5 add ball_2 like ball at 2 2 0\nat 6 delete ball\n"
               "at 9 delete jelly\nat 10 delete ball_2\nat 3 delete wall\n");
  REQUIRE(export_run(folder, export_scene(), {"--script", "change.script"}, 12).code == 0);
  REQUIRE(impinge_run(folder.path(), {"export", "out", "--format", "gltf"}).code == 0);
  const Glb glb(folder / "out/export/s.glb");
  CHECK(glb.bodies().size() == 9);
  std::map<std::string, int> shown;
  for (std::size_t frame = 0; frame <= 12; ++frame)
    for (const std::string& name : glb.bodies()) {
      const fs::path truth = folder / fmt::format("out/surfaces/{:06}/{}.ply", frame, name);
      Aabb box;
      const std::vector<Vec3> points = glb.surface(name, frame);
      for (const Vec3& x : points) box.include(x);
      CAPTURE(frame, name);
      CHECK((box.extent().norm() > 0.0) == fs::exists(truth));
      if (!fs::exists(truth)) continue;
      ++shown[name];
      const TriangleMesh surface = read_mesh(truth);
      double worst = 0.0;
      for (std::size_t v = 0; v < points.size(); ++v)
        worst = std::max(worst, (points[v] - surface.vertices[v]).cwiseAbs().maxCoeff());
      CHECK(worst < 1e-5);
    }
  CHECK(shown == std::map<std::string, int>{{"ball", 6},
                                            {"ball_2", 5},
                                            {"drop", 13},
                                            {"jelly", 9},
                                            {"jelly_2", 9},
                                            {"paddle", 13},
                                            {"tetra-1", 13},
                                            {"tetra_1", 13},
                                            {"wall", 3}});
}

TEST_CASE("a glTF of one frame has no animation") {
  const TempFolder folder;
  REQUIRE(export_run(folder, export_scene(), {}, 3).code == 0);
  REQUIRE(impinge_run(folder.path(), {"export", "out", "--format", "gltf", "--frames", "3"}).code == 0);
  const Glb glb(folder / "out/export/s.glb");
  CHECK(glb.times.empty());
  CHECK(!glb.is_animated("jelly"));
  CHECK(glb.surface("jelly", 0).size() == read_mesh(folder / "out/surfaces/000003/jelly.ply").vertices.size());
}
