// Bad input through the program: exit code 2, exactly one message, located, with what to do about it, and nothing
// written.
#include <catch2/catch.hpp>

#include <unistd.h>

#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/program/refusal.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"([simulation]
substeps = 2
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 1, 1] } }
position = [0, 2, 0]
)";

const std::vector<std::string> kRun = {"run", "s.toml", "--out", "out", "--frames", "2", "--no-images"};

std::vector<std::string> run_with(std::vector<std::string> more) {
  std::vector<std::string> words = kRun;
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void check_scene(const std::string& text, const std::string& place, const std::string& contains) {
  const TempFolder folder;
  folder.write("s.toml", text);
  INFO(text);
  check_refused(folder, kRun, "s.toml:" + place + ": ", contains);
}

}  // namespace

TEST_CASE("the scene that the bad ones are made from is good") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const Outcome outcome = impinge_run(folder.path(), kRun);
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  CHECK(fs::exists(folder / "out/done"));
}

TEST_CASE("scenes that can't be taken are refused at the right place") {
  const std::string scene = kScene;
  check_scene("[simulation\nsubsteps = 2\n", "1:1", "broken TOML");
  check_scene("[simulation]\nsubsteps = \n", "2:12", "broken TOML");
  check_scene(scene + "\nmass = 1\nmass = 2\n", "14:8", "already exists");
  check_scene(replaced(scene, "substeps = 2", "substepz = 2"), "2:1", "did you mean 'simulation.substeps'?");
  check_scene(replaced(scene, "[simulation]", "[simulatoin]"), "1:2", "did you mean 'simulation'?");
  check_scene(replaced(scene, "substeps = 2", "substeps = \"two\""), "2:12", "an integer in [1, 1000]");
  check_scene(replaced(scene, "substeps = 2", "substeps = 2.5"), "2:12", "an integer in [1, 1000]");
  check_scene(replaced(scene, "substeps = 2", "substeps = 0"), "2:12", "out of range");
  check_scene(replaced(scene, "substeps = 2", "substeps = 99999999999999999999999"), "2:12",
              "'99999999999999999999999' is out of range");
  check_scene(replaced(scene, "substeps = 2", "gravity = [0, nan, 0]"), "2:15", "nan");
  check_scene(replaced(scene, "substeps = 2", "gravity = [0, 1e999, 0]"), "2:15", "allowed");
  check_scene(replaced(scene, "substeps = 2", "gravity = [0, inf, 0]"), "2:15", "inf");
  check_scene(replaced(scene, "substeps = 2", "gravity = [0, -9.81]"), "2:11", "[x, y, z]");
  check_scene(replaced(scene, "substeps = 2", "gravity = 9.81"), "2:11", "[x, y, z]");
  check_scene(replaced(scene, "[simulation]\nsubsteps = 2", "[narrow_phase]\nmethod = \"octree\""), "2:10",
              "is not known");
  check_scene(replaced(scene, "[simulation]\nsubsteps = 2", "[response]\nmethod = \"constraint_anticipatoin\""), "2:10",
              "did you mean 'constraint_anticipation'?");
  check_scene(replaced(scene, "position = [0, 2, 0]", "positon = [0, 2, 0]"), "11:1", "did you mean 'position'?");
  check_scene(replaced(scene, "position = [0, 2, 0]", "mass = -1"), "11:8", "greater than 0");
  check_scene(replaced(scene, "position = [0, 2, 0]", "mass = 0"), "11:8", "greater than 0");
  check_scene(replaced(scene, "position = [0, 2, 0]", "mass = nan"), "11:8", "greater than 0");
  check_scene(replaced(scene, "position = [0, 2, 0]", "scale = -2"), "11:9", "greater than 0");
  check_scene(replaced(scene, "position = [0, 2, 0]", "material = { density = 1e999 }"), "11:24",
              "greater than 0 and at most");
  check_scene(replaced(scene, "position = [0, 2, 0]", "material = { young = 1e5 }"), "11:14",
              "belongs to deformable bodies");
  check_scene(replaced(scene, "position = [0, 2, 0]", "friction = -0.5"), "11:12", "[0, 100]");
  check_scene(replaced(scene, "position = [0, 2, 0]", "motion = [ { time = 0 } ]"), "11:1", "scripted bodies have one");
  check_scene(replaced(scene, "kind = \"dynamic\"", "kind = \"scripted\""), "7:1", "has no motion");
  check_scene(replaced(scene, "kind = \"dynamic\"", "kind = \"scripted\"\nmotion = [ { time = 1 }, { time = 1 } ]"),
              "10:35", "times must increase");
  check_scene(replaced(scene, "kind = \"dynamic\"", "kind = \"dynamik\""), "9:8", "did you mean 'dynamic'?");
  check_scene(replaced(scene, "kind = \"dynamic\"", "kind = \"deformable\""), "7:1", "has no volume");
  check_scene(replaced(scene, "kind = \"static\"", "kind = \"dynamic\""), "6:9", "a plane is static or scripted");
  check_scene(replaced(scene, "name = \"crate\"", "name = \"floor\""), "8:8", "names must differ");
  check_scene(replaced(scene, "name = \"crate\"", "name = \"a crate\""), "8:8", "rename it");
  check_scene(replaced(scene, "name = \"crate\"\n", ""), "7:1", "without a name");
  check_scene(replaced(scene, "size = [1, 1, 1]", "size = [1, 0, 1]"), "10:30", "greater than 0");
  check_scene(replaced(scene, "box = { size", "bx = { size"), "10:11", "did you mean 'box'?");
  check_scene("[[body]]\nname = 3\n", "2:8", "a text is wanted");
  check_scene("[body]\nname = \"a\"\n", "1:1", "[[body]]");
  check_scene(replaced(scene, "[[body]]\nname = \"floor\"", "[[bodies]]\nname = \"floor\""), "3:3",
              "unknown table 'bodies'; allowed: body, attachment, ");
  check_scene("[[bodies]]\nname = \"a\"\n", "1:3", "did you mean 'body'?");
  check_scene("[[attachments]]\nname = \"a\"\n", "1:3", "did you mean 'attachment'?");
  check_scene(scene + "[[attachment]]\nbody_a = \"crate\"\nanchor = [0, 2, 0]\n", "14:1",
              "write point = [x, y, z], one place in world coordinates");
  check_scene(replaced(scene, "position = [0, 2, 0]", "material = { mass = 2 }"), "11:14",
              "write it beside material, not within");
  check_scene(replaced(scene, "kind = \"dynamic\"",
                       "kind = \"deformable\"\nvolume = { lattice = { cells = 1 } }\nmaterial = { mass = 2 }"),
              "11:21", "write it beside material, not within");
  check_scene("a = " + std::string(100, '[') + std::string(100, ']') + "\n", "1:69", "nested deeper");
}

TEST_CASE("sizes and masses out of their ranges are refused at their keys, the same by --set") {
  const std::string scene = kScene, box = "shape = { box = { size = [1, 1, 1] } }";
  const std::string sizes = "a length greater than 0, in [1e-6, 1e6] m, is allowed", masses = "in [1e-15, 1e15] kg";
  check_scene(replaced(scene, "[1, 1, 1]", "[1e-200, 1, 1]"), "10:27", "body.crate.shape.box.size is 1e-200; " + sizes);
  check_scene(replaced(scene, "[1, 1, 1]", "[1, 9.9e-7, 1]"), "10:30", sizes);
  check_scene(replaced(scene, "[1, 1, 1]", "[1, 1, 1.1e6]"), "10:33", sizes);
  check_scene(replaced(scene, box, "shape = { sphere = { radius = 1e-7 } }"), "10:31", sizes);
  check_scene(replaced(scene, box, "shape = { sphere = { radius = 2e6 } }"), "10:31", sizes);
  check_scene(replaced(scene, box, "shape = { capsule = { radius = 1e-7, length = 1 } }"), "10:32", sizes);
  check_scene(replaced(scene, box, "shape = { capsule = { radius = 1, length = 1e7 } }"), "10:44", sizes);
  check_scene(replaced(scene, box, box + "\nscale = 1e-7"), "10:27", "1, 1e-07 with the scale 1e-07; " + sizes);
  // a static body has a size too
  check_scene(replaced(scene, "plane = { normal = [0, 1, 0], offset = 0 }", "sphere = { radius = 1e9 }"), "6:31",
              sizes);
  check_scene(replaced(scene, "position = [0, 2, 0]", "mass = 1e16"), "11:8", masses);
  check_scene(replaced(scene, "position = [0, 2, 0]", "mass = 1e-16"), "11:8", "body.crate.mass is 1e-16; a mass");
  // what the density makes of the size
  check_scene(replaced(scene, "position = [0, 2, 0]", "material = { density = 1e-300 }"), "11:24",
              "the mass of body.crate is 1e-300 kg by its density; a mass in [1e-15, 1e15] kg is allowed");
  check_scene(replaced(scene, "[1, 1, 1]", "[1e6, 1e6, 1e6]"), "7:1", "1e+21 kg by its density; a mass in [1e-15");

  const TempFolder folder;
  folder.write("s.toml", scene);
  const auto refused = [&](const std::string& text, const std::string& says) {
    check_refused(folder, run_with({"--set", text}), "--set " + text + ": ", says);
  };
  refused("body.crate.shape.box.size=[1e-200,1,1]", "body.crate.shape.box.size is 1e-200; " + sizes);
  refused("body.crate.mass=1e16", "body.crate.mass is 1e+16; a mass greater than 0, " + masses + ", is allowed");
  refused("body.crate.material.density=1e-300", "the mass of body.crate is 1e-300 kg by its density");

  // at the ends of the ranges, and where a mass is never used, they are taken
  const auto taken = [&](const std::string& text) {
    folder.write("t.toml", text);
    const Outcome outcome = impinge_run(folder.path(), {"check", "t.toml"});
    INFO(text << outcome.err);
    CHECK(outcome.code == 0);
  };
  taken(replaced(scene, box, "shape = { sphere = { radius = 1e-6 } }\nmaterial = { density = 1e6 }"));
  taken(replaced(scene, box, "shape = { box = { size = [1e6, 1e6, 1] } }"));
  taken(replaced(scene, "plane = { normal = [0, 1, 0], offset = 0 }", "box = { size = [1e6, 1e6, 1e6] }"));
  taken(replaced(scene, "position = [0, 2, 0]", "mass = 1e15"));
  taken(replaced(scene, "position = [0, 2, 0]", "mass = 1e-15"));
  taken(replaced(scene, box, "shape = { box = { size = [1e-7, 1e-7, 1e-7] } }\nscale = 1e6"));
}

TEST_CASE("a surface that its scale takes out of the range of sizes is refused") {
  const TempFolder folder;
  folder.write("m.off", off_text(tetrahedron()));
  const auto check = [&](const std::string& keys, const std::string& contains) {
    folder.write("s.toml", "[[body]]\nname = \"a\"\nkind = \"dynamic\"\nsurface = \"m.off\"\n" + keys);
    check_refused(folder, kRun, "s.toml:4:11: body.a.surface = \"m.off\" is ", contains);
  };
  check("scale = 1e-7", "with the scale 1e-07; lengths in [1e-6, 1e6] m are allowed");
  check("scale = 1e6", "lengths in [1e-6, 1e6] m are allowed");
  TriangleMesh thin = tetrahedron();
  for (Vec3& x : thin.vertices) x.z() *= 1e-7;
  folder.write("m.off", off_text(thin));
  check("", " m long in z; lengths in");
}

TEST_CASE("meshes that bound no solid are refused with the remedy") {
  const TriangleMesh good = tetrahedron();
  const auto check_mesh = [](const std::string& text, const std::string& start, const std::string& contains) {
    const TempFolder folder;
    folder.write("m.off", text);
    folder.write("s.toml", "[[body]]\nname = \"a\"\nkind = \"dynamic\"\nsurface = \"m.off\"\n");
    INFO(text);
    check_refused(folder, kRun, start, contains);
  };
  check_mesh("OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n", "m.off: ", "no faces");
  check_mesh(replaced(off_text(good), "1.1", "nan"), "m.off:4:1: ", "finite");
  TriangleMesh mesh = good;
  mesh.triangles.pop_back();
  check_mesh(off_text(mesh), "s.toml:4:11: ", "not closed");
  mesh = good;
  mesh.vertices.emplace_back(3, 3, 3);
  mesh.triangles.push_back({0, 1, 4});
  check_mesh(off_text(mesh), "s.toml:4:11: ", "manifold");
  mesh = good;
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  check_mesh(off_text(mesh), "s.toml:4:11: ", "inside out");
  mesh = good;
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  check_mesh(off_text(mesh), "s.toml:4:11: ", "orient");
  check_mesh("garbage", "m.off:1:1: ", "OFF");
  check_mesh("", "m.off:1: ", "ends early");
}

TEST_CASE("files that are not there, not files or out of bounds are refused") {
  const TempFolder folder;
  const std::string body = "[[body]]\nname = \"a\"\nkind = \"dynamic\"\nsurface = ";
  const auto surface = [&](const std::string& name) { folder.write("scene/s.toml", body + "\"" + name + "\"\n"); };
  const std::vector<std::string> run = {"run", "scene/s.toml", "--out", "out", "--frames", "1", "--no-images"};
  folder.write("secret.off", off_text(tetrahedron()));
  surface("../secret.off");
  check_refused(folder, run, "scene/s.toml:4:11: ", "leads out of the scene's folder");
  surface((folder / "secret.off").string());
  check_refused(folder, run, "scene/s.toml:4:11: ", "leads out of the scene's folder");
  surface("sub/../../secret.off");
  check_refused(folder, run, "scene/s.toml:4:11: ", "leads out of the scene's folder");
  fs::create_symlink("../secret.off", folder / "scene/link.off");
  surface("link.off");
  check_refused(folder, run, "scene/s.toml:4:11: ", "leads out of the scene's folder");
  surface("nothing.off");
  check_refused(folder, run, "scene/s.toml:4:11: ", "no such file");
  surface(".");
  check_refused(folder, run, "scene/s.toml:4:11: ", "");
  check_refused(folder, {"run", "none.toml", "--out", "out", "--no-images"}, "none.toml: ", "no such file");
  check_refused(folder, {"run", "scene", "--out", "out", "--no-images"}, "scene: ", "not a regular file");
  check_refused(folder, {"check", "none.toml"}, "none.toml: ", "no such file");

  // the opt-in lets the same file in
  folder.write("scene/s.toml", "[scene]\nallow_outside_files = true\n" + body + "\"../secret.off\"\n");
  CHECK(impinge_run(folder.path(), {"check", "scene/s.toml"}).code == 0);
}

TEST_CASE("overrides are checked like the scene, and the message names them") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const auto refused = [&](const std::string& text, const std::string& contains) {
    check_refused(folder, run_with({"--set", text}), "--set " + text + ": ", contains);
  };
  refused("simulation.gravitty=[0,0,0]", "did you mean 'simulation.gravity'?");
  refused("simulation.gravity=[0,0]", "[x, y, z]");
  refused("simulation.gravity=down", "[x, y, z]");
  refused("simulation.gravity=0,0,-9.8", "put it in brackets: [0,0,-9.8]");
  refused("body.crate.position=0,1,0", "put it in brackets: [0,1,0]");
  refused("view.layers=meshes,normals", "put it in brackets: [meshes,normals]");
  refused("contact.friction=nan", "not a number");
  refused("contact.friction=-1", "out of range");
  refused("body.crat.mass=1", "did you mean 'crate'?");
  refused("body.crate.mas=1", "did you mean 'mass'?");
  refused("body.crate.mass=-1", "greater than 0");
  refused("contact.friction", "no PATH=VALUE");
  refused("contact..friction=1", "empty name");
  refused("narrow_phase.method=octree", "is not known");
}

TEST_CASE("scripts are checked before frame 0, the nearest name is given") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const auto refused = [&](const std::string& script, const std::string& place, const std::string& contains) {
    INFO(script);
    folder.write("a.script", script);
    check_refused(folder, run_with({"--script", "a.script"}), "a.script:" + place + ": ", contains);
  };
  refused("# fine\nat 1 set body.crat.velocity 0 1 0\n", "2:10", "did you mean 'body.crate.velocity'?");
  refused("at 1 set contact.friction\n", "1:6", "without a path and a value");
  refused("at 1 set contact.friction lots\n", "1:27", "a real number in [0, 100]");
  refused("at 1 set contact.friction -3\n", "1:27", "out of range");
  refused("at 1 set simulation.gravity 0 1\n", "1:29", "[x, y, z]");
  refused("at 1 layer +contact\n", "1:13", "did you mean 'contacts'?");
  refused("at 1 layer contacts\n", "1:12", "put + or -");
  refused("at -1 layer +contacts\n", "1:4", "a frame number");
  refused("at 1 camera orbt 1 2\n", "1:13", "did you mean 'orbit'?");
  refused("at 1 camera orbit 1\n", "1:13", "with 1 numbers");
  refused("set contact.friction 0\n", "1:1", "put 'at K' before it");
  refused("from 5 to 3 ramp contact.friction 0 1\n", "1:11", "ends at or after");
  refused("from 1 to 3 ramp contact.points 0 1\n", "1:18", "is no number");
  refused("from 1 to 3 ramp contact.friction 0\n", "1:1", "incomplete ramp");
  refused("expect contact > 0 at 1\n", "1:8", "did you mean 'contacts'?");
  refused("expect contacts > at 1\n", "1:18", "should stand here");
  refused("expect contacts at 1\n", "1:8", "a condition is wanted");
  refused("expect contacts > 0\n", "1:1", "without 'at K'");
  refused("expect image nothing.png at 1\n", "1:14", "there is no file");
  refused("break when contacts >> 1\n", "1:22", "should stand here");
  refused("explode at 1\n", "1:1", "a line starts with");
  check_refused(folder, run_with({"--script", "none.script"}), "none.script: ", "no such file");
}

TEST_CASE("folders that can't be written to, or hold something else, are left alone") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  folder.write("taken/notes.txt", "mine");
  check_refused(folder, {"run", "s.toml", "--out", "taken", "--frames", "1", "--no-images"},
                "taken: ", "holds notes.txt");
  folder.write("file", "mine");
  check_refused(folder, {"run", "s.toml", "--out", "file", "--frames", "1", "--no-images"},
                "file: ", "a folder is wanted");
  check_refused(folder, {"run", "s.toml", "--out", "file/out", "--frames", "1", "--no-images"},
                "file/out: ", "can't be made");
  check_refused(folder, {"run", "s.toml", "--out", "/proc/impinge", "--frames", "1", "--no-images"},
                "/proc/impinge: ", "can't be made");
  if (geteuid() != 0) {  // root may write everywhere
    fs::create_directory(folder / "locked");
    fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    check_refused(folder, {"run", "s.toml", "--out", "locked", "--frames", "1", "--no-images"},
                  "locked/run.toml: ", "can't be written");
    fs::permissions(folder / "locked", fs::perms::owner_all);
  }
}

TEST_CASE("the command line names what is wrong with it") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const auto refused = [&](const std::vector<std::string>& words, const std::string& contains) {
    check_refused(folder, words, "command line: ", contains);
  };
  refused({"rum", "s.toml"}, "did you mean 'run'?");
  refused({"trace"}, "not part of this version");
  refused({"verify"}, "NAME");
  refused({"verify", "stacks"}, "no case 'stacks'");
  refused({"verify", "ccd"}, "--queries");
  refused({"debug", "s.toml", "--vnc", "5900"}, "this build has no VNC");
  refused({"debug", "s.toml", "--headless"}, "--script");
  refused({"run"}, "SCENE");
  refused({"run", "s.toml", "--frame", "3"}, "--frames");
  refused({"run", "s.toml", "--frames", "-3"}, "whole number");
  refused({"run", "s.toml", "--frames", "3x"}, "whole number");
  refused({"run", "s.toml", "--frames", "3", "--frames", "4"},
          "command line: --frames stands twice; it takes one value");
  refused({"run", "s.toml", "--threads", "1", "--threads=2", "--threads", "3"}, "--threads stands 3 times");
  refused({"run", "s.toml", "--out=a", "--no-images", "--out", "b"}, "--out stands twice");
  CHECK(impinge_run(folder.path(), {"run", "s.toml", "--no-images", "--no-images", "--frames", "0", "--out", "once",
                                    "--set", "contact.friction=0", "--set", "simulation.substeps=1"})
            .code == 0);
  refused({"run", "s.toml", "--size", "1280"}, "WIDTHxHEIGHT");
  refused({"run", "s.toml", "--size", "0x0"}, "width");
  refused({"run", "s.toml", "--threads", "0"}, "--threads");
  refused({"run", "s.toml", "--ids", "--no-images"}, "--ids");
  refused({"compare", "a"}, "B");
  refused({"run", "s.toml", "--export", "stl"}, "one of ply, sequence, obj, ");
  refused({"run", "s.toml", "--export", "stl"}, "poses.csv");
  refused({"export", "out", "--format", "sequence"}, "write --format ply");
  refused({"list", "parameter"}, "did you mean 'parameters'?");
  CHECK(impinge_run(folder.path(), {"--help"}).code == 0);
  CHECK(impinge_run(folder.path(), {"run", "--help"}).out.find("--resume") != std::string::npos);
  CHECK(impinge_run(folder.path(), {}).code == 2);
}
