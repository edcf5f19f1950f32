// Bad deformable bodies and attachments through the program: exit code 2, one located message with a remedy, nothing
// written.
#include <catch2/catch.hpp>

#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/tet_writers.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/program/refusal.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr const char* kScene = R"([simulation]
substeps = 2
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "jelly"
kind = "deformable"
shape = { box = { size = [0.2, 0.2, 0.2] } }
volume = { cage = { cells = 3 } }
material = { young = 1e5, poisson = 0.4, density = 1000 }
position = [0, 0.3, 0]
fixed = { box = { min = [-1, 0.38, -1], max = [1, 1, 1] } }
[[attachment]]
body_a = "jelly"
body_b = "floor"
point = [0, 0.25, 0]
)";
constexpr const char *kKind = "kind = \"deformable\"", *kShape = "shape = { box = { size = [0.2, 0.2, 0.2] } }",
                     *kVolume = "volume = { cage = { cells = 3 } }";
constexpr const char* kShapeAndVolume =
    "shape = { box = { size = [0.2, 0.2, 0.2] } }\nvolume = { cage = { cells = 3 } }";
constexpr const char* kMaterial = "material = { young = 1e5, poisson = 0.4, density = 1000 }";
constexpr const char* kFixed = "fixed = { box = { min = [-1, 0.38, -1], max = [1, 1, 1] } }";
constexpr const char* kAttachment = "body_a = \"jelly\"\nbody_b = \"floor\"\npoint = [0, 0.25, 0]\n";

const std::vector<std::string> kRun = {"run", "s.toml", "--out", "out", "--frames", "1", "--no-images"};

// the scene with `from` exchanged, in a folder of good and bad meshes; `start` is where the message says it is
void check_refused_at(const std::string& from, const std::string& to, const std::string& start,
                      const std::string& contains) {
  static const TempFolder folder;
  static const bool written = [] {
    const TetMesh cube = make_tet_box(Vec3::Constant(0.2), 2, 2, 2);
    const TriangleMesh surface = boundary_surface(cube);
    TriangleMesh open = surface, far = surface;
    open.triangles.pop_back();
    for (Vec3& x : far.vertices) x.x() += 3.0;
    TetMesh inverted = cube;
    std::swap(inverted.tets[3][0], inverted.tets[3][1]);
    folder.write("cube.off", off_text(surface));
    folder.write("open.off", off_text(open));
    folder.write("far.off", off_text(far));
    folder.write("cube.veg", veg_text(cube));
    folder.write("bad.veg", replaced(veg_text(cube), "ELEMENTS\nTET\n48 4 0\n1 1 2 5 14\n",
                                     "ELEMENTS\nTET\n48 4 0\n1 1 2 5 140\n"));
    folder.write("inverted.msh", msh22_text(inverted));
    folder.write("lonely.node", node_text(cube));
    return true;
  }();
  REQUIRE(written);
  const std::string scene = replaced(kScene, from, to);
  folder.write("s.toml", scene);
  INFO(scene);
  check_refused(folder, kRun, start + ": ", contains);
}

void refused_material(const std::string& keys, const std::string& place, const std::string& contains) {
  check_refused_at(kMaterial, "material = { " + keys + " }", "s.toml:12:" + place, contains);
}

void check_refused_fixed(const std::string& value, const std::string& place, const std::string& contains) {
  check_refused_at(kFixed, "fixed = " + value, "s.toml:14:" + place, contains);
}

}  // namespace

TEST_CASE("the deformable scene that the bad ones are made from is good") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const Outcome outcome = impinge_run(folder.path(), kRun);
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
}

TEST_CASE("volumes that can't be made are refused at the right place") {
  check_refused_at(kKind, "kind = \"deformabel\"", "s.toml:9:8", "did you mean 'deformable'?");
  check_refused_at(kKind, "kind = \"dynamic\"", "s.toml:11:1", "belongs to deformable bodies");
  check_refused_at(kKind, "kind = \"static\"", "s.toml:11:1", "belongs to deformable bodies");
  check_refused_at(kVolume, "", "s.toml:7:1", "add volume = ");
  check_refused_at(kVolume, "volume = 3", "s.toml:11:10", "a file name, or a table");
  check_refused_at(kVolume, "volume = [true]", "s.toml:11:10", "a file name, or a table");
  check_refused_at(kVolume, "volume = {}", "s.toml:11:10", "names 0 ways");
  check_refused_at(kVolume, "volume = { cage = { cells = 3 }, lattice = { cells = 3 } }", "s.toml:11:10",
                   "names 2 ways");
  check_refused_at(kVolume, "volume = { cge = { cells = 3 } }", "s.toml:11:12", "did you mean 'cage'?");
  check_refused_at(kVolume, "volume = { cage = 3 }", "s.toml:11:19", "a table { ... } is wanted");
  check_refused_at(kVolume, "volume = { cage = {} }", "s.toml:11:19", "has no cells");
  check_refused_at(kVolume, "volume = { cage = { cell = 3 } }", "s.toml:11:21", "did you mean 'cells'?");
  check_refused_at(kVolume, "volume = { cage = { cells = 1 } }", "s.toml:11:29", "[2, 200]");
  check_refused_at(kVolume, "volume = { cage = { cells = 201 } }", "s.toml:11:29", "[2, 200]");
  check_refused_at(kVolume, "volume = { cage = { cells = 2.5 } }", "s.toml:11:29", "a whole number");
  check_refused_at(kVolume, "volume = { cage = { cells = nan } }", "s.toml:11:29", "nan");
  check_refused_at(kVolume, "volume = { lattice = { cells = \"many\" } }", "s.toml:11:32", "a real number");
  check_refused_at(kShapeAndVolume, "shape = { sphere = { radius = 0.1 } }\nvolume = { lattice = { cells = 3 } }",
                   "s.toml:11:12", "use a cage");
  check_refused_at(kShapeAndVolume, "surface = \"cube.off\"\nvolume = { lattice = { cells = 3 } }", "s.toml:11:12",
                   "use a cage");
  check_refused_at(kShape, "", "s.toml:7:1", "has no surface");
  check_refused_at(kShape, "shape = { plane = { normal = [0, 1, 0] } }", "s.toml:10:9", "sphere, box, capsule");
  check_refused_at(kShape, "shape = { capsule = { radius = 1 } }", "s.toml:10:21", "has no length");
  check_refused_at(kShapeAndVolume, std::string(kShape) + "\nsurface = \"cube.off\"\n" + kVolume, "s.toml:11:1",
                   "one of them is wanted");
  check_refused_at(kShape, "surface = \"none.off\"", "s.toml:10:11", "there is no such file");
  check_refused_at(kShape, "surface = \"open.off\"", "s.toml:10:11", "not closed");
  check_refused_at(kShape, "shape = { box = { size = [0.2, 0.2, -1] } }", "s.toml:10:37", "greater than 0");
}

TEST_CASE("deformable bodies out of the ranges of sizes and masses are refused at the right place") {
  const std::string sizes = "[1e-6, 1e6] m", masses = "[1e-15, 1e15] kg";
  check_refused_at(kShape, "shape = { box = { size = [0.2, 1e-200, 0.2] } }", "s.toml:10:32", sizes);
  check_refused_at(kShape, "shape = { sphere = { radius = 1e7 } }", "s.toml:10:31", sizes);
  check_refused_at(kShape, std::string(kShape) + "\nscale = 1e-6", "s.toml:10:27", sizes);
  check_refused_at(kShapeAndVolume, "volume = \"cube.veg\"\nscale = 1e-6", "s.toml:10:10",
                   "m long in x with the scale 1e-06");
  check_refused_at(kShape, "surface = \"cube.off\"\nscale = 1e-6", "s.toml:10:11", sizes);
  check_refused_at(kMaterial, "mass = 1e16", "s.toml:12:8", masses);
  check_refused_at(kMaterial, "mass = 1e-16", "s.toml:12:8", masses);
  refused_material("density = 1e-200", "24", "kg by its density; a mass in " + masses);
}

TEST_CASE("volume files that don't fit are refused at the right place") {
  check_refused_at(kShapeAndVolume, "volume = \"none.veg\"", "s.toml:10:10", "there is no such file");
  check_refused_at(kShapeAndVolume, "volume = \"../secret.veg\"", "s.toml:10:10", "leads out of the scene's folder");
  check_refused_at(kShapeAndVolume, "volume = \"\"", "s.toml:10:10", "name a file");
  check_refused_at(kVolume, "volume = \"cube.veg\"", "s.toml:10:1", "remove shape");
  check_refused_at(kShapeAndVolume, "volume = \"cube.off\"", "cube.off", ".veg, .node/.ele and .msh are read");
  check_refused_at(kShapeAndVolume, "volume = \"bad.veg\"", "bad.veg:36:9", "vertex 140");
  check_refused_at(kShapeAndVolume, "volume = \"inverted.msh\"", "inverted.msh:45:1", "inverted");
  check_refused_at(kShapeAndVolume, "volume = \"lonely.node\"", "s.toml:10:10", "'lonely.ele' is not there");
  check_refused_at(kShapeAndVolume, "surface = \"far.off\"\nvolume = \"cube.veg\"", "s.toml:11:10",
                   "outside of the volume");
}

TEST_CASE("materials that don't exist are refused at the right place") {
  check_refused_at(kMaterial, "material = \"jelly\"", "s.toml:12:12", "a table { ... } is wanted");
  refused_material("modle = \"corotational\"", "14", "did you mean 'model'?");
  refused_material("model = \"corotationl\"", "22", "did you mean 'corotational'?");
  refused_material("model = 3", "22", "a text is wanted");
  refused_material("model = \"\"", "22", "neo_hookean");
  refused_material("tangent = \"exakt\"", "24", "did you mean 'exact'?");
  refused_material("tangent = true", "24", "one of automatic, exact, projected");
  refused_material("young = 0", "22", "[0.001, 1e+15] Pa");
  refused_material("young = -1e5", "22", "[0.001, 1e+15] Pa");
  refused_material("young = \"stiff\"", "22", "a real number");
  refused_material("young = 1e16", "22", "[0.001, 1e+15] Pa");
  refused_material("young = nan", "22", "nan");
  refused_material("poisson = 0.5", "24", "[0, 0.49999]");
  refused_material("poisson = -0.1", "24", "[0, 0.49999]");
  refused_material("poisson = \"0.3\"", "24", "a real number");
  refused_material("density = 0", "24", "greater than 0");
  refused_material("density = [1]", "24", "an array");
  refused_material("damping = 0.01", "24", "write damping = [0, 0.01]");
  refused_material("damping = [0.01]", "24", "write damping = [0, 0.01]");
  refused_material("damping = [0, -1]", "28", "[0, 1000]");
  refused_material("damping = [0, inf]", "28", "inf");
  refused_material("damping_alpha = -1", "30", "[0, 1e+06]");
  refused_material("damping_beta = 1e9", "29", "[0, 1000]");
  refused_material("damping_beta = \"x\"", "29", "a real number");
  refused_material("mass = \"heavy\"", "21", "one of lumped, consistent");
  refused_material("mass = 3", "21", "one of lumped, consistent");
  refused_material("extension_threshold = 0", "36", "[0.001, 0.9]");
  refused_material("extension_threshold = 1", "36", "[0.001, 0.9]");
  check_refused_at(kMaterial, std::string(kMaterial) + "\nmass = 3", "s.toml:13:1", "a mass and a density");
  check_refused_at(kMaterial, "mass = 0", "s.toml:12:8", "greater than 0");
  check_refused_at(kMaterial, std::string(kMaterial) + "\nmotion = [ { time = 0 } ]", "s.toml:13:1",
                   "scripted bodies have one");
}

TEST_CASE("held regions that hold nothing, or make no sense, are refused at the right place") {
  check_refused_fixed("3", "9", "an integer");
  check_refused_fixed("{}", "9", "names 0 regions");
  check_refused_fixed("[]", "9", "lists no region");
  check_refused_fixed("[3]", "10", "fixed[0] is 3");
  check_refused_fixed("{ bx = {} }", "11", "did you mean 'box'?");
  check_refused_fixed("{ box = 3 }", "17", "a table { ... } is wanted");
  check_refused_fixed("{ box = {} }", "17", "has no min");
  check_refused_fixed("{ box = { min = [0, 0, 0] } }", "17", "has no max");
  check_refused_fixed("{ box = { min = [1, 1, 1], max = [0, 0, 0] } }", "17", "exchange them");
  check_refused_fixed("{ box = { min = [0, 0], max = [1, 1, 1] } }", "25", "[x, y, z]");
  check_refused_fixed("{ box = { min = [5, 5, 5], max = [6, 6, 6] } }", "9",
                      "holds no node; the body's nodes lie in [-0.1");
  check_refused_fixed("{ sphere = { radius = 1 } }", "20", "has no center");
  check_refused_fixed("{ sphere = { center = [0, 0, 0] } }", "20", "has no radius");
  check_refused_fixed("{ sphere = { center = [0, 0, 0], radius = 0 } }", "51", "greater than 0");
  check_refused_fixed("{ sphere = { center = [0, 0, nan], radius = 1 } }", "38", "nan");
  check_refused_fixed("{ nodes = [0], sphere = { center = [0, 0, 0], radius = 1 } }", "9", "names 2 regions");
  check_refused_fixed("{ nodes = [] }", "19", "lists no node");
  check_refused_fixed("{ nodes = 3 }", "19", "nodes is an integer");
  check_refused_fixed("{ nodes = [0, 1.5] }", "23", "holds a fraction");
  check_refused_fixed("{ nodes = [-1] }", "20", "[0, 1e+09]");
  check_refused_fixed("{ nodes = [\"a\"] }", "20", "a real number");
  check_refused_fixed("{ nodes = [0, 99999] }", "9", "the body has nodes 0 to ");
  check_refused_fixed("[ { nodes = [7] }, { nodes = [0, 1, 2, -0] }, { nodes = [7] } ]", "55",
                      "fixed[2] holds no node that the regions before it leave");
  check_refused_fixed("{ nodes = [0], motion = 3 }", "33", "motion is an integer");
  check_refused_fixed("{ nodes = [0], motion = [] }", "33", "no key frames");
  check_refused_fixed("{ nodes = [0], motion = [ { position = [0, 0, 0] } ] }", "35", "has no time");
  check_refused_fixed("{ nodes = [0], motion = [ { time = 1 }, { time = 0 } ] }", "58", "times must increase");
  check_refused_fixed("{ nodes = [0], motion = [ { time = 0, velocity = [0, 0, 0] } ] }", "47",
                      "allowed: time, position, rotation");
}

TEST_CASE("attachments that join nothing are refused at the right place") {
  const auto refused_attachment = [](const std::string& keys, const std::string& place, const std::string& contains) {
    check_refused_at(kAttachment, keys, "s.toml:" + place, contains);
  };
  check_refused_at("[[attachment]]", "[attachment]", "s.toml:15:1", "write [[attachment]]");
  refused_attachment("", "15:1", "has no body_a");
  refused_attachment("body_a = \"jelly\"\n", "15:1", "has no point");
  refused_attachment("body_b = \"jelly\"\npoint = [0, 0.3, 0]\n", "15:1", "has no body_a");
  refused_attachment("body_a = \"\"\npoint = [0, 0.3, 0]\n", "16:10", "names the body \"\"");
  refused_attachment("body_a = \"jely\"\npoint = [0, 0.3, 0]\n", "16:10", "did you mean 'jelly'?");
  refused_attachment("body_a = \"zzzzzzz\"\npoint = [0, 0.3, 0]\n", "16:10", "bodies: floor, jelly");
  refused_attachment("body_a = \"jelly\"\nbody_b = \"jelly\"\npoint = [0, 0.3, 0]\n", "17:10", "with itself");
  refused_attachment("body_a = \"floor\"\npoint = [0, 0, 0]\n", "15:1", "joins nothing that can move");
  refused_attachment("body_a = \"jelly\"\nbody_b = 3\npoint = [0, 0.3, 0]\n", "17:10", "a text is wanted");
  refused_attachment("body_a = \"jelly\"\nbody_c = \"floor\"\npoint = [0, 0.3, 0]\n", "17:1",
                     "allowed: name, kind, body_a, body_b, point, direction, normal, on, collide");
  refused_attachment("body_a = \"jelly\"\npoint = [0, 0.3]\n", "17:9", "[x, y, z]");
  refused_attachment("body_a = \"jelly\"\npoint = [0, nan, 0]\n", "17:13", "nan");
  refused_attachment("body_a = \"jelly\"\npoint = [5, 5, 5]\n", "15:1", "outside of the deformable body 'jelly'");
  refused_attachment("name = 3\nbody_a = \"jelly\"\npoint = [0, 0.3, 0]\n", "16:8", "a text is wanted");
  refused_attachment(std::string("name = \"hook\"\n") + kAttachment + "[[attachment]]\nname = \"hook\"\n" + kAttachment,
                     "20:1", "a second attachment named 'hook'");
}

TEST_CASE("overrides and scripts of a deformable body are checked like the scene") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const auto refused_override = [&](const std::string& text, const std::string& contains) {
    std::vector<std::string> words = kRun;
    words.insert(words.end(), {"--set", text});
    check_refused(folder, words, "--set " + text + ": ", contains);
  };
  refused_override("body.jelly.material.young=-1", "[0.001, 1e+15] Pa");
  refused_override("body.jelly.material.yung=1", "did you mean 'young'?");
  refused_override("body.jelly.material=1", "a table { ... } is wanted");
  refused_override("body.jelly.volume.cage.cells=0", "[2, 200]");
  refused_override("body.floor.material.young=1e5", "belongs to deformable bodies");
  const auto refused_script = [&](const std::string& line, const std::string& place, const std::string& contains) {
    folder.write("a.script", line);
    std::vector<std::string> words = kRun;
    words.insert(words.end(), {"--script", "a.script"});
    check_refused(folder, words, "a.script:" + place + ": ", contains);
  };
  refused_script("at 1 set body.jelly.material.young 0\n", "1:36", "out of range");
  refused_script("at 1 set body.jelly.material.poisson 0.5\n", "1:38", "out of range");
  refused_script("at 1 set body.jelly.material.yung 1e5\n", "1:10", "did you mean 'body.jelly.material.young'?");
  refused_script("at 1 set body.jelly.fixed_1.displacement 0 1 0\n", "1:10",
                 "did you mean 'body.jelly.fixed_0.displacement'?");
  refused_script("at 1 set body.jelly.fixed_0.displacement 0 1\n", "1:42", "[x, y, z]");
  refused_script("at 1 set body.jelly.velocity 0 1 0\n", "1:10", "unknown parameter 'body.jelly.velocity'");
}
