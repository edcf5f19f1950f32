// What somebody may write who means something that there is, under another name or elsewhere: the message leads there.
#include <catch2/catch.hpp>

#include "tests/support/program/refusal.hpp"

using namespace impinge::test;

namespace {

constexpr const char* kFloorAndBall =
    "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n"
    "[[body]]\nname = \"ball\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.1 } }\nposition = [0, 1, 0]\n";

}  // namespace

TEST_CASE("a debugger's line in the script of a run is told for one") {
  TempFolder folder;
  folder.write("s.toml", kFloorAndBall);
  folder.write("a.script", "at 1 set contact.friction 0.1\nstep 5\n");
  check_refused(folder, {"run", "s.toml", "--script", "a.script", "--no-images"}, "a.script:2:1: 'step'",
                "a line of impinge debug --script");
}

TEST_CASE("a key that a body of its kind doesn't have is no other body's") {
  TempFolder folder;
  folder.write("s.toml", kFloorAndBall);
  folder.write("a.script", "at 0 set body.floor.velocity 1 0 0\n");
  check_refused(folder, {"run", "s.toml", "--script", "a.script", "--no-images"},
                "a.script:1:10: 'floor' has no velocity, as bodies of other kinds do", "it has ");
  folder.write("a.script", "at 0 set body.flor.velocity 1 0 0\n");
  check_refused(folder, {"run", "s.toml", "--script", "a.script", "--no-images"}, "a.script:1:10: unknown parameter",
                "body.");
}

TEST_CASE("a deformable body's velocity is told of where no body of the scene has one") {
  TempFolder folder;
  folder.write("s.toml",
               "[[body]]\nname = \"jelly\"\nkind = \"deformable\"\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n"
               "volume = { cage = { cells = 2 } }\n");
  folder.write("a.script", "at 0 set body.jelly.velocity 1 0 0\n");
  check_refused(folder, {"run", "s.toml", "--script", "a.script", "--no-images"},
                "a.script:1:10: unknown parameter 'body.jelly.velocity'", "`move` and `push`");
}

TEST_CASE("a coefficient's other word and a date are shown as they are written") {
  TempFolder folder;
  const std::string ball = "[[body]]\nname = \"b\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.1 } }\n";
  folder.write("s.toml", ball + "friction = \"scenee\"\n");
  check_refused(folder, {"check", "s.toml"}, "s.toml:5:12: body.b.friction is \"scenee\" (a text)",
                "a real number or \"scene\" is wanted");
  folder.write("s.toml", ball + "position = 1979-05-27\n");
  check_refused(folder, {"check", "s.toml"}, "s.toml:5:12: body.b.position is \"1979-05-27\" (a date or time)",
                "a vector [x, y, z] is wanted");
}

TEST_CASE("tetrahedra as a surface are refused at their line, with the line that takes them") {
  TempFolder folder;
  folder.write("meshes/a.msh", "$MeshFormat\n");
  folder.write("s.toml", "[[body]]\nname = \"a\"\nkind = \"dynamic\"\nsurface = \"meshes/a.msh\"\n");
  check_refused(folder, {"check", "s.toml"}, "s.toml:4:11: surface \"meshes/a.msh\" holds tetrahedra",
                "volume = \"meshes/a.msh\"");
}

TEST_CASE("help is a command too, and the usage begins as it is typed") {
  TempFolder folder;
  const Outcome all = impinge_run(folder.path(), {"help"}), one = impinge_run(folder.path(), {"help", "run"});
  CHECK(all.code == 0);
  CHECK(all.out == impinge_run(folder.path(), {"--help"}).out);
  CHECK(one.out == impinge_run(folder.path(), {"run", "--help"}).out);
  CHECK(one.out.find("Usage: impinge run ") != std::string::npos);
}
