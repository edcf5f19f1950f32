// Deformable bodies and attachments from scene files: each kind loads, is what its formula says, and steps.
#include <catch2/catch.hpp>

#include "engine/geometry/mass_properties.hpp"
#include "engine/io/scene/scene.hpp"
#include "engine/shapes/primitives.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/tet_writers.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct LoadedBodies {
  World world;
  ParameterSet rows;
  Scene scene;
  explicit LoadedBodies(const std::filesystem::path& path, const std::vector<std::string>& overrides = {}) {
    world.parameters.bind(rows);
    scene = load_scene(path, overrides, world, rows);
  }
  const Body& body(int i = 0) const { return world.bodies()[i]; }
  const DeformableBody& soft(int i = 0) const { return deformable(world, i); }
  /// Two frames; whether all nodes are where numbers can be.
  bool steps() {
    world.start();
    world.step();
    world.step();
    for (const Body& b : world.bodies())
      if (!b.center_of_mass().allFinite()) return false;
    return true;
  }
};

std::string body_text(const std::string& lines) { return "[[body]]\nname = \"a\"\nkind = \"deformable\"\n" + lines; }

/// A box of 0.2 x 0.1 x 0.3 m about (0.1, 0.05, 0.15), irregular inside.
TetMesh sample_volume() {
  TetMesh mesh = make_tet_box(Vec3(0.2, 0.1, 0.3), 2, 2, 2);
  mesh.vertices[13] += Vec3(0.01, -0.005, 0.02);  // the one inside
  return mesh;
}

}  // namespace

TEST_CASE("exact shapes become bodies of their volume, with every way of filling them") {
  const TempFolder folder;
  const double ball = 4.18879020e-3, pill = ball + 3.14159265e-2 * 0.2;  // r = 0.1, cylinder 0.2 m long
  // cages: tetrahedra that the surface only touches weigh 2 % of full ones; balls and capsules: inscribed triangles
  struct Case {
    const char* lines;
    double volume, tolerance;
  };
  for (const Case& c :
       {Case{"shape = { sphere = { radius = 0.1 } }\nvolume = { cage = { cells = 6 } }\n", ball, 0.03},
        Case{"shape = { box = { size = [0.2, 0.1, 0.3] } }\nvolume = { cage = { cells = 6 } }\n", 6e-3, 0.02},
        Case{"shape = { capsule = { radius = 0.1, length = 0.2 } }\nvolume = { cage = { cells = 6 } }\n", pill, 0.03},
        Case{"shape = { box = { size = [0.2, 0.1, 0.3] } }\nvolume = { lattice = { cells = 6 } }\n", 6e-3, 1e-9}}) {
    INFO(c.lines);
    LoadedBodies s(folder.write("s.toml", body_text(c.lines)));
    const Body& body = s.body();
    CHECK(body.mass == Approx(1000.0 * c.volume).epsilon(c.tolerance));
    CHECK(s.soft().embedding.outside == 0);
    // the surface that collides is the shape's, moved by nothing yet
    const TriangleMesh& surface = body.shape->mesh()->mesh;
    REQUIRE(body.world_vertices.size() == surface.vertices.size());
    for (std::size_t v = 0; v < surface.vertices.size(); ++v)
      CHECK((body.world_vertices[v] - surface.vertices[v]).norm() < 1e-12);
    CHECK(s.steps());
  }
  // cells as cubic as the sides allow: 2:1:3
  const LoadedBodies lattice(folder.write(
      "s.toml", body_text("shape = { box = { size = [0.2, 0.1, 0.3] } }\nvolume = { lattice = { cells = 6 } }\n")));
  CHECK(lattice.soft().nodes() == 5 * 3 * 7);
}

TEST_CASE("volume files of every format give the same body") {
  const TempFolder folder;
  const TetMesh mesh = sample_volume();
  folder.write("v.veg", veg_text(mesh));
  folder.write("v.node", node_text(mesh));
  folder.write("v.ele", ele_text(mesh));
  folder.write("two.msh", msh22_text(mesh));
  folder.write("four.msh", msh41_text(mesh));
  for (const char* name : {"v.veg", "v.node", "v.ele", "two.msh", "four.msh"}) {
    INFO(name);
    LoadedBodies s(folder.write(
        "s.toml",
        body_text(fmt::format(
            "volume = \"{}\"\nscale = 2\nrotation = [0, 90, 0]\nposition = [1, 2, 3]\nmaterial = {{ density = 500 }}\n",
            name))));
    REQUIRE(s.soft().nodes() == 27);
    CHECK(s.body().mass == Approx(8 * 500 * 6e-3));
    Mat3 turn;  // 90° about y: x goes to -z
    turn << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    for (int i = 0; i < 27; ++i)
      CHECK((Vec3(s.soft().position.segment<3>(3 * i)) - (turn * (2.0 * mesh.vertices[i]) + Vec3(1, 2, 3))).norm() <
            1e-12);
    const TriangleMesh& boundary = s.body().shape->mesh()->mesh;
    CHECK(boundary.vertices.size() == 26);
    CHECK(signed_volume(boundary) == Approx(8 * 6e-3));
    REQUIRE(s.scene.surfaces.size() == 1);
    CHECK(s.scene.surfaces[0].tets == 48);
    CHECK(s.steps());
  }
}

TEST_CASE("a surface is carried by a volume file, both are scaled, a little outside is taken") {
  const TempFolder folder;
  folder.write("v.veg", veg_text(sample_volume()));
  TriangleMesh surface = box_surface(Vec3(0.1, 0.05, 0.15), Eigen::Vector3i(3, 2, 4));
  for (Vec3& x : surface.vertices) x = 1.02 * x + Vec3(0.1, 0.05, 0.15);  // 3 mm outside at most
  folder.write("s.off", off_text(surface));
  LoadedBodies s(folder.write("s.toml", body_text("volume = \"v.veg\"\nsurface = \"s.off\"\nscale = 3\n")));
  CHECK(s.soft().embedding.outside == static_cast<int>(surface.vertices.size()));
  for (std::size_t v = 0; v < surface.vertices.size(); ++v)
    CHECK((s.body().world_vertices[v] - 3.0 * surface.vertices[v]).norm() < 1e-12);
  CHECK(s.steps());
}

TEST_CASE("every material key arrives, mass is shared out over what is filled") {
  const TempFolder folder;
  const std::string shape = "shape = { sphere = { radius = 0.1 } }\nvolume = { cage = { cells = 4 } }\n";
  for (const char* model : {"linear", "corotational", "stvk", "fixed_corotated", "neo_hookean", "mass_spring"}) {
    INFO(model);
    LoadedBodies s(
        folder.write("s.toml", body_text(shape +
                                         "mass = 2.5\nself_collision = true\nfriction = 0.7\nrestitution = "
                                         "0.2\nvelocity = [1, 2, 3]\nangular_velocity = [0, 0, 2]\n" +
                                         fmt::format("material = {{ model = \"{}\", young = 3e4, poisson = 0.3, "
                                                     "damping = [0.5, 0.02], mass = \"consistent\" }}\n",
                                                     model))));
    const DeformableBody& soft = s.soft();
    CHECK(soft.model == model);
    CHECK(soft.material->settings().young == 3e4);
    CHECK(soft.material->settings().poisson == 0.3);
    CHECK(soft.damping.alpha == 0.5);
    CHECK(soft.damping.beta == 0.02);
    CHECK(soft.fem.mass_kind() == MassKind::consistent);
    CHECK(s.body().mass == Approx(2.5));
    CHECK(s.body().self_collision);
    CHECK(s.body().friction == 0.7);
    CHECK(s.body().restitution == 0.2);
    CHECK((soft.momentum() - 2.5 * Vec3(1, 2, 3)).norm() < 1e-12);
    CHECK(s.steps());
  }
  const LoadedBodies s(
      folder.write(
          "s.toml",
          body_text(shape +
                    "material = { model = \"neo_hookean\", extension_threshold = 0.2, tangent = \"exact\" }\n")),
      {"body.a.material.young=7e3"});
  CHECK(std::get<double>(s.rows.find("body.a.material.extension_threshold")->get()) == 0.2);
  CHECK(s.soft().material->settings().tangent == Tangent::exact);
  CHECK(s.soft().material->settings().young == 7e3);
}

TEST_CASE("a volume file's own material is used where the scene is silent") {
  const TempFolder folder;
  folder.write("v.veg", veg_text(sample_volume()) +
                            "\n*MATERIAL rubber\nENU, 1234, 5e5, 0.25\n\n*REGION\nallElements, rubber\n");
  const LoadedBodies own(folder.write("s.toml", body_text("volume = \"v.veg\"\n")));
  CHECK(own.soft().material->settings().young == 5e5);
  CHECK(own.soft().material->settings().poisson == 0.25);
  CHECK(own.body().mass == Approx(1234 * 6e-3));
  const LoadedBodies given(
      folder.write("s.toml", body_text("volume = \"v.veg\"\nmaterial = { young = 1e3, density = 10 }\n")));
  CHECK(given.soft().material->settings().young == 1e3);
  CHECK(given.soft().material->settings().poisson == 0.25);
  CHECK(given.body().mass == Approx(10 * 6e-3));
}

TEST_CASE("regions hold the nodes they name, and move them") {
  const TempFolder folder;
  const std::string lines =
      "shape = { box = { size = [0.2, 0.2, 0.2] } }\nvolume = { lattice = { cells = 4 } }\nposition = [0, 1, 0]\nfixed "
      "= ";
  {
    LoadedBodies s(
        folder.write("s.toml", body_text(lines + "{ box = { min = [-1, 0.89, -1], max = [1, 0.91, 1] } }\n")));
    REQUIRE(s.soft().held.size() == 1);
    CHECK(s.soft().held[0].nodes.size() == 25);
    for (const int i : s.soft().held[0].nodes) CHECK(s.soft().position[3 * i + 1] == Approx(0.9));
    CHECK(s.soft().dofs() == 3 * 100);
    CHECK(s.steps());
  }
  {
    LoadedBodies s(folder.write(
        "s.toml", body_text(lines + "[ { sphere = { center = [0.1, 1.1, 0.1], radius = 0.06 } }, { nodes = [0, 1, 2], "
                                    "motion = [ { time = 0 }, { time = 0.03, position = [0.01, 0, 0] } ] } ]\n")));
    REQUIRE(s.soft().held.size() == 2);
    CHECK(s.soft().held[0].nodes.size() == 4);  // a corner and its three neighbours
    CHECK(s.soft().held[1].nodes == std::vector<int>{0, 1, 2});
    const VecX start = s.soft().position;
    CHECK(s.steps());  // two frames of 1/60 s: past the last key
    for (const int i : {0, 1, 2})
      CHECK((s.soft().position.segment<3>(3 * i) - start.segment<3>(3 * i) - Vec3(0.01, 0, 0)).norm() < 1e-12);
    for (const int i : s.soft().held[0].nodes)
      CHECK((s.soft().position.segment<3>(3 * i) - start.segment<3>(3 * i)).norm() < 1e-15);
  }
}

TEST_CASE("attachments join bodies to one another and to the world") {
  const TempFolder folder;
  const std::string a = body_text("shape = { sphere = { radius = 0.1 } }\nvolume = { cage = { cells = 3 } }\n");
  LoadedBodies s(folder.write(
      "s.toml",
      a + "[[body]]\nname = \"b\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.1 } }\nposition = [0, 0.5, 0]\n"
          "[[attachment]]\nbody_a = \"a\"\nbody_b = \"b\"\npoint = [0, 0.2, 0]\n[[attachment]]\nname = "
          "\"nail\"\nbody_a = \"b\"\npoint = [0, 0.6, 0]\n"));
  CHECK(s.scene.attachments.size() == 2);
  CHECK(s.steps());
}

TEST_CASE("bodies of one surface share one volume, and a resolved scene gives the same world") {
  const TempFolder folder, other;
  folder.write("s.off", off_text(sphere_surface(0.1, 2)));
  const std::string body = "kind = \"deformable\"\nsurface = \"s.off\"\nvolume = { cage = { cells = 4 } }\n";
  std::string text;
  for (int i = 0; i < 4; ++i) text += fmt::format("[[body]]\nname = \"b{}\"\nposition = [{}, 0, 0]\n{}", i, i, body);
  const LoadedBodies s(folder.write("s.toml", text + "scale = 2\n"));
  for (int i = 1; i < 3; ++i) CHECK(s.soft(i).fem.rest().tets == s.soft(0).fem.rest().tets);
  CHECK(s.body(3).mass == Approx(8 * s.body(0).mass));

  RunRecord run;
  run.version = "1";
  run.scene = "s.toml";
  run.folder = folder.path().string();
  const LoadedBodies again(other.write("run.toml", format_run(s.scene, s.rows, run)));
  CHECK(again.world.state_hash() == s.world.state_hash());
}
