// The scenes that come with the program do what their scripts expect of them; and what of a script is refused or passed
// over before anything runs.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <fstream>

#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/refusal.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

/// The last frame that an `expect` line speaks of.
int last_expectation(const fs::path& script) {
  std::ifstream file(script);
  int last = -1;
  for (std::string line; std::getline(file, line);)
    if (const std::size_t at = line.rfind(" at "); line.starts_with("expect ") && at != std::string::npos)
      last = std::max(last, std::stoi(line.substr(at + 4)));
  return last;
}

}  // namespace

TEST_CASE("every scene's script finds what it expects", "[long]") {
  int scenes = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(IMPINGE_SOURCE_DIR) / "scenes")) {
    const fs::path scene = entry.path(), script = fs::path(scene).replace_extension(".script");
    if (scene.extension() != ".toml" || !fs::exists(script)) continue;
    const int last = last_expectation(script);
    CAPTURE(scene.string(), last);
    CHECK(last > 0);
    const TempFolder folder;
    const Outcome outcome =
        impinge_run(folder.path(), {"run", scene.string(), "--script", script.string(), "--out", "out", "--frames",
                                    std::to_string(last), "--no-images", "--quiet"});
    INFO(outcome.err);
    CHECK(outcome.code == 0);
    ++scenes;
  }
  CHECK(scenes >= 6);
}

namespace {

constexpr const char* kTwoBalls =
    "[[body]]\nname = \"crate\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 1 } }\n"
    "[[body]]\nname = \"ball\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 1 } }\nposition = [4, 0, 0]\n";

}  // namespace

TEST_CASE("what acts on a body that a script has deleted by then is refused where it stands") {
  const TempFolder folder;
  folder.write("s.toml", kTwoBalls);
  struct Case {
    const char *line, *place;
  };
  const Case cases[] = {{"at 5 push crate 0 1 0", "2:11"},
                        {"at 5 move crate 0 1 0", "2:11"},
                        {"at 2 pull crate 0 0 0 to 1 1 1", "2:11"},
                        {"at 3 release crate", "2:14"},
                        {"at 9 delete crate", "2:13"},
                        {"at 5 set body.crate.friction 0.1", "2:10"},
                        {"from 1 to 4 ramp body.crate.friction 0 1", "2:18"},
                        {"at 5 follow crate", "2:13"}};
  for (const Case& c : cases) {
    CAPTURE(c.line);
    folder.write("a.script", std::string("at 2 delete crate\n") + c.line + "\n");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"check", "s.toml", "--script", "a.script"},
          {"run", "s.toml", "--script", "a.script", "--no-images", "--frames", "3", "--out", "o"}})
      check_refused(folder, words, "a.script:" + std::string(c.place) + ": 'crate' in frame ",
                    ", which line 1 deletes in frame 2; a body that is there is wanted; ");
  }
  folder.write("a.script", "at 4 add new like ball at 0 9 0\nat 2 push new 0 1 0\n");
  check_refused(folder, {"check", "s.toml", "--script", "a.script"}, "a.script:2:11: 'new' in frame 2",
                "which line 1 adds in frame 4; ");
  // before it is deleted, and of how the other is drawn
  folder.write("a.script",
               "at 3 delete crate\nat 2 push crate 0 1 0\nat 5 push ball 0 1 0\nat 5 hide crate\n"
               "from 0 to 2 ramp body.crate.friction 0 1\nat 4 add new like ball at 0 9 0\nat 4 push new 0 1 0\n");
  const Outcome fine = impinge_run(folder.path(), {"check", "s.toml", "--script", "a.script"});
  INFO(fine.err);
  CHECK(fine.code == 0);
}

TEST_CASE("a mark of byte order at the start of a script or a surface is passed over") {
  const std::string mark = "\xEF\xBB\xBF";
  const TempFolder folder;
  folder.write("s.toml", mark + kTwoBalls);
  folder.write("a.script", mark + "at 2 delete crate\nat 1 pushh ball\n");
  check_refused(folder, {"check", "s.toml", "--script", "a.script"}, "a.script:2:6: ", "'pushh'");
  folder.write("a.script", mark + "at 2 deletee crate\n");
  check_refused(folder, {"check", "s.toml", "--script", "a.script"}, "a.script:1:6: ", "'deletee'");
  folder.write("a.script", mark + "at 2 delete crate\n");
  CHECK(impinge_run(folder.path(), {"check", "s.toml", "--script", "a.script"}).code == 0);
  folder.write("d.script", mark + "step 2\n");
  const Outcome debug = impinge_run(folder.path(), {"debug", "s.toml", "--headless", "--script", "d.script"});
  INFO(debug.err);
  CHECK(debug.code == 0);
  const TriangleMesh cube = box(Vec3::Constant(0.5));
  std::string obj;
  for (const Vec3& v : cube.vertices) obj += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  for (const Triangle& t : cube.triangles) obj += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  folder.write("cube.obj", mark + obj);
  folder.write("cube.off", mark + off_text(cube));
  write_ply(folder / "plain.ply", cube.vertices, cube.triangles);
  folder.write("cube.ply", mark + slurp(folder / "plain.ply"));
  for (const char* file : {"cube.obj", "cube.off", "cube.ply"}) {
    CAPTURE(file);
    const Outcome page = impinge_run(folder.path(), {"mesh", file});
    INFO(page.err);
    CHECK(page.out.find("volume 1 m³") != std::string::npos);
  }
}
