#include "engine/io/scene/scene.hpp"

#include <catch2/catch.hpp>

#include "engine/bodies/scripted_body.hpp"
#include "engine/core/error.hpp"
#include "engine/io/scene/toml.hpp"
#include "engine/shapes/primitives.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Loaded {
  World world;
  ParameterSet rows;
  Scene scene;
  Loaded(const std::filesystem::path& path, const std::vector<std::string>& overrides = {}) {
    world.parameters.bind(rows);
    scene = load_scene(path, overrides, world, rows);
  }
};

constexpr const char* kScene = R"([simulation]
frame_time = 0.02
substeps = 5
gravity = [0, -10, 1]   # integers are taken for reals
[contact]
friction = 1
[[body]]
name = "half"
kind = "static"
shape = { plane = { normal = [0, 2, 0], offset = 3 } }
scale = 2
[[body]]
name = "tetra"
kind = "dynamic"
surface = "meshes/t.off"
scale = 2.0
mass = 3
position = [1, 2, 3]
rotation = [0, 90, 0]
velocity = [1, 0, 0]
angular_velocity = [0, 0, 2]
friction = 0.25
[[body]]
name = "pill"
kind = "scripted"
shape = { capsule = { radius = 0.1, length = 0.6 } }
position = [0, 9, 0]
motion = [ { time = 0 }, { time = 1, position = [1, 9, 0], rotation = [0, 0, 90] } ]
)";

}  // namespace

TEST_CASE("a scene's parameters and bodies arrive in SI") {
  const TempFolder folder;
  folder.write("meshes/t.off", off_text(tetrahedron()));
  const Loaded s(folder.write("s.toml", kScene));
  CHECK(s.world.parameters.simulation.frame_time == 0.02);
  CHECK(s.world.parameters.simulation.substeps == 5);
  CHECK(s.world.parameters.simulation.gravity == Vec3(0, -10, 1));
  CHECK(s.world.parameters.contact.friction == 1.0);
  REQUIRE(s.world.bodies().size() == 3);

  // n·x = offset with n as written: y = 1.5, doubled by the scale
  const Plane& plane = *s.world.bodies()[0].shape->as<Plane>();
  CHECK(plane.normal == Vec3(0, 1, 0));
  CHECK(plane.offset == Approx(3.0));

  const RigidBody& tetra = rigid(s.world, 1);
  CHECK(tetra.mass == Approx(3.0));
  CHECK(tetra.friction == 0.25);
  CHECK_FALSE(tetra.restitution.has_value());
  CHECK(tetra.velocity == Vec3(1, 0, 0));
  CHECK((tetra.angular_velocity() - Vec3(0, 0, 2)).norm() < 1e-12);
  Mat3 turn;  // 90° about y: x goes to -z
  turn << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  for (int v = 0; v < 4; ++v)
    CHECK((tetra.world_vertices[v] - (turn * (2.0 * tetrahedron().vertices[v]) + Vec3(1, 2, 3))).norm() < 1e-12);

  const auto& pill = body_as<ScriptedBody>(s.world, 2);
  CHECK(pill.shape->as<Capsule>()->half_length == Approx(0.3));
  CHECK((pill.motion.at(0.0).position - Vec3(0, 9, 0)).norm() < 1e-15);  // a key without position has the body's
  CHECK((pill.motion.at(5.0).position - Vec3(1, 9, 0)).norm() < 1e-15);
  CHECK(s.scene.surfaces.size() == 1);
  CHECK(s.scene.has("contact.friction"));
  CHECK_FALSE(s.scene.has("contact.restitution"));
}

TEST_CASE("overrides replace what the scene says, bodies by name") {
  const TempFolder folder;
  folder.write("meshes/t.off", off_text(tetrahedron()));
  const Loaded s(
      folder.write("s.toml", kScene),
      {"simulation.gravity=[0,-20,0]", "body.tetra.mass=7", "body.pill.shape.capsule.radius=0.2",
       "contact.points=intersection", "simulation.sleeping=false", "contact.friction=0.5", "contact.friction=0.75"});
  CHECK(s.world.parameters.simulation.gravity == Vec3(0, -20, 0));
  CHECK(s.world.bodies()[1].mass == Approx(7.0));
  CHECK(s.world.bodies()[2].shape->as<Capsule>()->radius == 0.2);
  CHECK(s.world.parameters.contact.points == ContactPoints::intersection);
  CHECK_FALSE(s.world.parameters.simulation.sleeping);
  CHECK(s.world.parameters.contact.friction == 0.75);
}

TEST_CASE("a resolved scene is a scene: it loads to the same world and writes the same text") {
  const TempFolder folder, other;
  folder.write("meshes/t.off", off_text(tetrahedron()));
  const Loaded s(folder.write("s.toml", kScene), {"body.tetra.position=[0.1,0.2,1e-30]", "lcp.tolerance=3e-9"});
  RunRecord run;
  run.version = "1";
  run.scene = "s.toml";
  run.folder = folder.path().string();
  run.script = {"at 0 set contact.friction 0.5", "# \"quotes\", \\ and \t tabs", ""};
  run.frames = 12;
  const std::string text = format_run(s.scene, s.rows, run);
  const Loaded again(other.write("run.toml", text));
  REQUIRE(again.scene.run.has_value());
  CHECK(again.scene.run->script == run.script);
  CHECK(again.scene.run->frames == 12);
  CHECK(again.world.state_hash() == s.world.state_hash());
  CHECK(format_run(again.scene, again.rows, *again.scene.run) == text);
  for (const Parameter& row : s.rows.all())
    CHECK(format_value(again.rows.find(row.path)->get()) == format_value(row.get()));
}

TEST_CASE("seams are welded, in the order of first appearance") {
  const TempFolder folder;
  folder.write("t.stl", stl_ascii(tetrahedron()));
  const Loaded s(folder.write("s.toml",
                              "[[body]]\nname = \"a\"\nkind = \"dynamic\"\nsurface = \"t.stl\"\n[[body]]\nname = "
                              "\"b\"\nkind = \"dynamic\"\nsurface = \"t.stl\"\n"));
  REQUIRE(s.scene.surfaces.size() == 1);
  CHECK(s.scene.surfaces[0].welded == 8);
  CHECK(s.scene.surfaces[0].vertices == 4);
  const TriangleMesh& mesh = s.world.bodies()[0].shape->mesh()->mesh;
  CHECK(mesh.triangles[0] == Triangle{0, 1, 2});
}

TEST_CASE("TOML values round trip through one line") {
  for (const char* text : {"[0, -20.5, 1e-300]", "true", "\"a \\\"b\\\" \\\\ \\n\"",
                           "{ a = [1, 2], b = { c = \"d\" } }", "[]", "9007199254740993"}) {
    const TomlNode node = parse_toml_value(text, "here");
    CHECK(format_toml(parse_toml_value(format_toml(node), "here")) == format_toml(node));
  }
  CHECK(parse_toml_value("1e5", "here").kind == TomlNode::real);
  CHECK(parse_toml_value("two words", "here").string == "two words");
  CHECK(parse_toml_value("[meshes, normals]", "here").items[1].string == "normals");
}
