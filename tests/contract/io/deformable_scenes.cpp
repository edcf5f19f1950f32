// Scenes of deformable bodies from every kind of volume: what arrives in the world, what moves, and that a run can be
// repeated.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "engine/bodies/deformable_body.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/tet_writers.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/controller/session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const Vec3 kSize(0.3, 0.2, 0.1);  // of the box whose volume the files hold, its lowest corner at the origin

struct Meshes {
  TempFolder folder;
  Meshes() {
    const TetMesh box = make_tet_box(kSize, 3, 2, 1);
    folder.write("box.veg", veg_text(box));
    folder.write(
        "material.veg",
        veg_text(box) + "\n*MATERIAL soft\nENU, 900, 20000, 0.3\n\n*SET all\n1\n\n*REGION\nallElements, soft\n");
    folder.write("box.msh", msh22_text(box));
    folder.write("box.node", node_text(box));
    folder.write("box.ele", ele_text(box));
    folder.write("inner.off", off_text(inner()));
    folder.write("ball.off", off_text(icosphere(2, 0.1)));
  }
  // a finer surface within the box, half as large
  static TriangleMesh inner() {
    TriangleMesh mesh = test::box(0.25 * kSize, {4, 4, 4});
    for (Vec3& x : mesh.vertices) x += 0.5 * kSize;
    return mesh;
  }
  std::unique_ptr<Session> open(const std::string& body, const std::string& script = "",
                                const std::vector<std::string>& overrides = {}) const {
    folder.write("s.toml", "[[body]]\nname = \"soft\"\nkind = \"deformable\"\n" + body);
    if (!script.empty()) folder.write("a.script", script);
    return std::make_unique<Session>(folder / "s.toml", overrides, script.empty() ? fs::path() : folder / "a.script");
  }
};

const DeformableBody& soft(const Session& session) { return deformable(session.world(), 0); }

// a free body falls as implicit Euler's point mass does: the sum of n steps of g h k, whatever it is made of
void check_falls(Session& session) {
  const Vec3 start = soft(session).center_of_mass();
  for (int i = 0; i < 5; ++i) session.advance();
  const auto& p = session.world().parameters.simulation;
  const double h = p.time_step(), n = 4.0 * p.substeps;  // frame 0 is the start
  const Vec3 fallen = soft(session).center_of_mass() - start;
  CHECK(fallen.y() == Approx(-9.81 * h * h * n * (n + 1.0) / 2.0).epsilon(1e-9));
  CHECK(std::hypot(fallen.x(), fallen.z()) < 1e-9);
}

}  // namespace

TEST_CASE("every kind of volume makes a body of the right mass that falls") {
  const Meshes meshes;
  const double box_mass = 1000.0 * kSize.prod();
  const auto check = [&](const std::string& body, double mass, double tolerance) {
    INFO(body);
    const auto session = meshes.open(body);
    CHECK(soft(*session).fem.total_mass() == Approx(mass).epsilon(tolerance));
    CHECK(session->world().bodies()[0].mass == Approx(mass).epsilon(tolerance));
    CHECK(check_tet_mesh(soft(*session).fem.rest()) == std::nullopt);
    check_falls(*session);
  };
  check("volume = \"box.veg\"\n", box_mass, 1e-12);
  check("volume = \"box.msh\"\n", box_mass, 1e-12);
  check("volume = \"box.node\"\n", box_mass, 1e-12);
  check("volume = \"box.ele\"\nrotation = [10, 20, 30]\nposition = [1, 2, 3]\n", box_mass, 1e-12);
  check("volume = \"box.veg\"\nscale = 2\n", 8.0 * box_mass, 1e-12);
  check("volume = \"box.veg\"\nsurface = \"inner.off\"\n", box_mass, 1e-12);
  check("volume = \"box.veg\"\nsurface = \"inner.off\"\nscale = 0.5\nmass = 3\n", 3.0, 1e-12);
  check("volume = \"material.veg\"\n", 0.9 * box_mass, 1e-12);
  check("volume = \"material.veg\"\nmaterial = { density = 500 }\n", 0.5 * box_mass, 1e-12);
  check("shape = { box = { size = [0.3, 0.2, 0.1] } }\nvolume = { lattice = { cells = 3 } }\n", box_mass, 1e-12);
  check(
      "shape = { box = { size = [0.3, 0.2, 0.1] } }\nvolume = { lattice = { cells = 3 } }\nmass = 2\nmaterial = { mass "
      "= \"consistent\" }\n",
      2.0, 1e-12);
  // of a cage the filled part counts, sampled by rays
  check("shape = { box = { size = [0.3, 0.2, 0.1] } }\nvolume = { cage = { cells = 4 } }\n", box_mass, 5e-3);
  const double ball = signed_volume(icosphere(2, 0.1));
  check("surface = \"ball.off\"\nvolume = { cage = { cells = 5 } }\nmaterial = { density = 700 }\n", 700.0 * ball,
        5e-3);
  check("surface = \"ball.off\"\nvolume = { cage = { cells = 5 } }\nscale = 2\nmass = 1.5\n", 1.5, 1e-12);
  check("shape = { sphere = { radius = 0.1 } }\nvolume = { cage = { cells = 6 } }\nmass = 1.5\n", 1.5, 1e-12);
}

TEST_CASE("a deformable body's material comes from the scene, its file, an override and a script") {
  const Meshes meshes;
  const auto settings = [](const Session& session) { return soft(session).material->settings(); };
  const auto file = meshes.open("volume = \"material.veg\"\n");
  CHECK(settings(*file).young == 20000.0);
  CHECK(settings(*file).poisson == 0.3);
  const auto over_file =
      meshes.open("volume = \"material.veg\"\nmaterial = { young = 7e4, model = \"neo_hookean\" }\n");
  CHECK(settings(*over_file).young == 7e4);
  CHECK(settings(*over_file).poisson == 0.3);

  const std::string body =
      "volume = \"box.veg\"\nmaterial = { young = 1e5, damping = [0.5, 0.01] }\nfixed = { box = { min = [-1, -1, -1], "
      "max = [0.01, 1, 1] } }\n";
  const std::string script =
      "at 2 set body.soft.material.young 1e6\nat 2 set body.soft.material.damping_beta 0.003\nfrom 3 to 5 ramp "
      "body.soft.material.poisson 0.3 0.4\n"
      "at 4 set body.soft.fixed_0.displacement 0 0.02 0\n";
  const auto s = meshes.open(body, script, {"body.soft.material.young=2e5", "body.soft.material.damping_alpha=0.25"});
  CHECK(settings(*s).young == 2e5);
  CHECK(soft(*s).damping.alpha == 0.25);
  CHECK(soft(*s).damping.beta == 0.01);
  for (int frame = 0; frame <= 5; ++frame) {
    s->advance();
    CHECK(settings(*s).young == (frame < 2 ? 2e5 : 1e6));
    CHECK(soft(*s).damping.beta == (frame < 2 ? 0.01 : 0.003));
    if (frame >= 3) CHECK(settings(*s).poisson == Approx(0.3 + 0.05 * (frame - 3)).epsilon(1e-12));
    const HeldRegion& held = soft(*s).held[0];
    CHECK(held.nodes.size() == 6);
    for (std::size_t k = 0; k < held.nodes.size(); ++k) {
      const Vec3 moved = soft(*s).position.segment<3>(3 * held.nodes[k]) - held.start[k];
      CHECK((moved - Vec3(0, frame < 4 ? 0.0 : 0.02, 0)).norm() < 1e-12);
    }
  }

  // a body without the table takes an override too
  const auto bare =
      meshes.open("volume = \"box.veg\"\n", "", {"body.soft.material.young=4e5", "body.soft.material.model=stvk"});
  CHECK(settings(*bare).young == 4e5);
}

TEST_CASE("the override's stiffness is felt: a held beam sags in inverse proportion to it") {
  const Meshes meshes;
  const auto sag = [&](const std::string& young) {
    const auto s = meshes.open(
        "volume = \"box.veg\"\nmaterial = { model = \"linear\", poisson = 0.3, damping = [50, 0.05] }\nfixed = { box = "
        "{ min = [-1, -1, -1], max = [0.01, 1, 1] } }\n",
        "", {"body.soft.material.young=" + young, "simulation.sleeping=false"});
    for (int i = 0; i < 120; ++i) s->advance();
    const int tip = 3;  // (i, j, k) = (3, 0, 0) of the lattice
    return soft(*s).rest_position(tip).y() - soft(*s).position[3 * tip + 1];
  };
  const double soft_sag = sag("2e6"), stiff_sag = sag("2e7");
  CHECK(soft_sag > 1e-5);
  CHECK(soft_sag / stiff_sag == Approx(10.0).epsilon(1e-3));
}

TEST_CASE("held regions of each kind hold what they contain and follow their key frames") {
  const Meshes meshes;
  const auto s = meshes.open(R"(volume = "box.veg"
position = [1, 0, 0]
fixed = [ { box = { min = [0.9, -1, -1], max = [1.01, 1, 1] } },
          { sphere = { center = [1.3, 0, 0], radius = 0.11 }, motion = [ { time = 0 }, { time = 0.05, position = [0.02, 0.01, 0] } ] },
          { nodes = [23] } ]
)");
  REQUIRE(soft(*s).held.size() == 3);
  CHECK(soft(*s).held[0].nodes == std::vector<int>{0, 4, 8, 12, 16, 20});  // i = 0 of 4 x 3 x 2 nodes
  CHECK(soft(*s).held[1].nodes == std::vector<int>{2, 3, 7, 15});          // within a cell's edge of (3, 0, 0)
  CHECK(soft(*s).held[2].nodes == std::vector<int>{23});
  CHECK(soft(*s).free_nodes() == 24 - 11);
  for (int i = 0; i < 6; ++i) s->advance();  // past the last key
  for (const int node : {0, 20, 23})
    CHECK((soft(*s).position.segment<3>(3 * node) - soft(*s).rest_position(node) - Vec3(1, 0, 0)).norm() < 1e-12);
  for (const int node : {2, 15})
    CHECK((soft(*s).position.segment<3>(3 * node) - soft(*s).rest_position(node) - Vec3(1.02, 0.01, 0)).norm() < 1e-12);

  // all of it held: a body without freedom is refused
  CHECK_THROWS_AS(meshes.open("volume = \"box.veg\"\nfixed = { sphere = { center = [0, 0, 0], radius = 9 } }\n"),
                  InputError);
}

TEST_CASE("attachments keep two points together: of a body and the world, of two bodies") {
  const Meshes meshes;
  const auto s = meshes.open(R"(volume = "box.veg"
[[body]]
name = "weight"
kind = "dynamic"
shape = { sphere = { radius = 0.05 } }
mass = 0.5
position = [0.3, -0.2, 0.05]
[[attachment]]
name = "hook"
body_a = "soft"
point = [0.05, 0.2, 0.05]
[[attachment]]
body_a = "weight"
body_b = "soft"
point = [0.3, 0, 0.05]
)");
  for (int i = 0; i < 30; ++i) s->advance();
  REQUIRE(s->record().attachments.size() == 2);
  CHECK(s->record().attachments[0].name == "hook");
  CHECK(s->record().attachments[1].name == "attachment_1");
  for (const AttachmentRecord& a : s->record().attachments) CHECK((a.point_a - a.point_b).norm() < 2e-3);
  CHECK((s->record().attachments[0].point_a - Vec3(0.05, 0.2, 0.05)).norm() < 2e-3);
  CHECK(soft(*s).center_of_mass().y() > -0.2);  // it hangs: without the hook it would have fallen 1.2 m
}

TEST_CASE("a run of deformable bodies is repeated by its run.toml, override and script included") {
  const Meshes meshes;
  meshes.folder.write("r.toml", R"([[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "ball"
kind = "deformable"
surface = "ball.off"
volume = { cage = { cells = 4 } }
position = [0, 0.11, 0]
[[body]]
name = "beam"
kind = "deformable"
volume = "box.msh"
surface = "inner.off"
position = [0.5, 0.3, 0]
fixed = [ { box = { min = [0.4, 0, -1], max = [0.51, 1, 1] } }, { nodes = [3], motion = [ { time = 0 }, { time = 0.1, position = [0, 0.01, 0] } ] } ]
[[body]]
name = "brick"
kind = "deformable"
shape = { box = { size = [0.2, 0.1, 0.1] } }
volume = { lattice = { cells = 2 } }
mass = 1
position = [-0.5, 0.06, 0]
[[attachment]]
name = "hook"
body_a = "beam"
point = [0.8, 0.4, 0.05]
)");
  meshes.folder.write("r.script",
                      "at 2 set body.ball.material.young 1e6\nat 3 set body.beam.fixed_0.displacement 0 0.005 0\n");
  const Outcome run =
      impinge_run(meshes.folder.path(), {"run", "r.toml", "--script", "r.script", "--out", "out", "--frames", "8",
                                         "--no-images", "--set", "body.brick.material.young=3e4"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Outcome replay = impinge_run("/", {"replay", (meshes.folder / "out").string()});
  INFO(replay.out << replay.err);
  CHECK(replay.code == 0);
  CHECK(replay.out.find("9 frames repeated") != std::string::npos);
  const std::string record = slurp(meshes.folder / "out/run.toml");
  CHECK(record.find("young = 30000") != std::string::npos);
  CHECK(record.find("[[attachment]]") != std::string::npos);
  const Outcome again = impinge_run("/", {"run", (meshes.folder / "out/run.toml").string(), "--out",
                                          (meshes.folder / "again").string(), "--no-images"});
  INFO(again.err);
  REQUIRE(again.code == 0);
  CHECK(slurp(meshes.folder / "again/run.toml") == record);
  CHECK(impinge_run("/", {"replay", (meshes.folder / "again").string()}).code == 0);

  // the volume's file is watched as the surface's is
  meshes.folder.write("box.msh", slurp(meshes.folder / "box.msh") + "\n");
  const Outcome changed = impinge_run(meshes.folder.path(), {"replay", "out"});
  CHECK(changed.code == 2);
  CHECK(changed.err.find("has changed since the run") != std::string::npos);
}
