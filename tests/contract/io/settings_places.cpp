// Settings that don't go together, and names that nothing has, told where they were given: the file's line, the
// override, or the script's line.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "tests/support/program/refusal.hpp"

using namespace impinge::test;

namespace {

const std::vector<std::string> kRun = {"run", "s.toml", "--out", "out", "--frames", "3", "--no-images"};

std::vector<std::string> run_with(const std::vector<std::string>& more) {
  std::vector<std::string> words = kRun;
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

constexpr const char* kBall = R"([[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 1 } }
)";

std::string with_ball(std::string head) { return head.append(kBall); }

}  // namespace

TEST_CASE("settings that don't go together are told at the one that was given last") {
  const TempFolder folder;
  const std::string both = "[simulation]\nvelocities = \"middle\"\n[response]\nmethod = \"quick\"\n";
  folder.write("s.toml", with_ball(both));
  const std::string found = "simulation.velocities is middle with response.method quick";
  check_refused(folder, kRun, fmt::format("s.toml:2:14: {}", found), "choose another one");
  check_refused(folder, {"check", "s.toml"}, fmt::format("s.toml:2:14: {}", found), "choose another one");

  folder.write("s.toml", with_ball("[response]\nmethod = \"quick\"\n"));
  check_refused(folder, run_with({"--set", "simulation.velocities=middle"}),
                fmt::format("--set simulation.velocities=middle: {}", found), "velocities = \"end\"");
  folder.write("s.toml", with_ball("[simulation]\nvelocities = \"middle\"\n"));
  check_refused(folder, run_with({"--set", "response.method=quick"}),
                fmt::format("--set response.method=quick: {}", found), "velocities = \"end\"");
  folder.write("s.toml", kBall);
  check_refused(folder, run_with({"--set", "simulation.velocities=middle", "--set", "response.method=quick"}),
                fmt::format("--set simulation.velocities=middle: {}", found), "velocities = \"end\"");

  // by a script, at the start and half way: what was made by then stays
  folder.write("s.toml", with_ball("[simulation]\nvelocities = \"middle\"\n"));
  for (const auto& [at, rows] : {std::pair("0", 1), {"2", 3}}) {
    CAPTURE(at);
    folder.write("a.script", fmt::format("# two lines\nat {} set response.method quick\n", at));
    const Outcome outcome =
        impinge_run(folder.path(), run_with({"--script", "a.script", "--force", "--set", "response.method=penalty"}));
    INFO(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.starts_with(fmt::format("a.script:2:26: {}", found)));
    const std::string table = slurp(folder / "out/stats.csv");
    CHECK(std::count(table.begin(), table.end(), '\n') == rows);
  }
}

TEST_CASE("names of bodies that a view gives and nothing has are told where they stand") {
  const TempFolder folder;
  const std::string view = "[view]\ncamera = { follow = \"bal\" }\n";
  folder.write("s.toml", with_ball(view));
  check_refused(folder, kRun, "s.toml:2:21: 'bal' for view.camera.follow; bodies: ball; ", "did you mean 'ball'?");
  check_refused(folder, run_with({"--set", "view.camera.follow=bll"}),
                "--set view.camera.follow=bll: 'bll' for view.camera.follow", "did you mean 'ball'?");
  folder.write("s.toml", with_ball("[view]\nhidden = [\"ball\", \"bil\"]\n"));
  check_refused(folder, kRun, "s.toml:2:10: 'bil' for view.hidden", "did you mean 'ball'?");
  folder.write("s.toml", with_ball("[view]\ncolors = [\"ball=red\"]\n"));
  check_refused(folder, kRun, "s.toml:2:10: 'ball=red' for view.colors", "NAME=rrggbb");
  folder.write("s.toml", kBall);
  folder.write("a.script", "at 1 set view.camera.follow bal\n");
  check_refused(folder, run_with({"--script", "a.script"}), "a.script:1:29: unknown body 'bal'",
                "did you mean 'ball'?");
}

TEST_CASE("a mesh that is not there is told where the scene, or an override, names it") {
  const TempFolder folder;
  const std::string body = "[[body]]\nname = \"a\"\nkind = \"static\"\nsurface = \"none.off\"\n";
  folder.write("s.toml", body);
  check_refused(folder, kRun, "s.toml:4:11: body.a.surface = \"none.off\": there is no such file", "check the path");
  folder.write("s.toml",
               std::string("[[body]]\nname = \"a\"\nkind = \"static\"\nshape = { sphere = { radius = 1 } }\n"));
  check_refused(folder, run_with({"--set", "body.a.shape={ convex_hull = { surface = \"none.off\" } }"}),
                "--set body.a.shape={ convex_hull = { surface = \"none.off\" } }: ", "there is no such file");
  folder.write("s.toml", body + "copies = [ { position = [1, 0, 0] } ]\n");
  check_refused(folder, kRun, "s.toml:4:11: body.a.surface", "there is no such file");
  folder.write("s.toml", replaced(body, "surface = \"none.off\"", "volume = \"none.veg\""));
  folder.write("s.toml", replaced(slurp(folder / "s.toml"), "static", "deformable"));
  check_refused(folder, kRun, "s.toml:4:10: ", "there is no such file");
}

TEST_CASE("a file that needs another beside it, which is not there, is told where the scene names it") {
  const TempFolder folder;
  const std::string soft =
      "[[body]]\nname = \"a\"\nkind = \"deformable\"\nvolume = \"m.node\"\nmaterial = { young = 1e5, poisson = 0.4, "
      "density = 1000 }\n";
  const std::string nodes = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", tets = "1 4 0\n1 1 2 3 4\n";
  folder.write("m.node", nodes);
  folder.write("s.toml", soft);
  check_refused(folder, kRun, "s.toml:4:10: file \"m.node\": 'm.ele' is not there; a TetGen mesh is", "put both into");
  // with the other one it is a body
  folder.write("m.ele", tets);
  CHECK(impinge_run(folder.path(), {"check", "s.toml"}).code == 0);
  std::filesystem::remove(folder / "m.node");
  folder.write("s.toml", replaced(soft, "m.node", "m.ele"));
  check_refused(folder, kRun, "s.toml:4:10: file \"m.ele\": 'm.node' is not there", "put both into");

  // a triangle of positions in a buffer that is a file of its own
  folder.write("t.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"uri":"t.bin","byteLength":36}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]})");
  const std::string sheet = "[[body]]\nname = \"a\"\nkind = \"static\"\nsurface = \"t.gltf\"\n";
  folder.write("s.toml", sheet);
  check_refused(folder, kRun, "s.toml:4:11: file \"t.gltf\": names '", "t.bin', which can't be opened; ");
  check_refused(folder, run_with({"--set", "body.a.surface=\"t.gltf\""}),
                "--set body.a.surface=\"t.gltf\": file \"t.gltf\": names '", "t.bin', which can't be opened; ");
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  folder.write("t.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
  CHECK(impinge_run(folder.path(), kRun).code == 0);
}

TEST_CASE("commands on files and folders that are not there say so") {
  const TempFolder folder;
  folder.write("s.toml", kBall);
  const std::vector<std::vector<std::string>> commands = {
      {"run", "no/where.toml", "--out", "out"},
      {"check", "no/where.toml"},
      {"info", "no/where.toml"},
      {"step", "no/where.toml"},
      {"replay", "no/where.toml"},
      {"export", "no/where.toml", "--format", "vtu"},
      {"compare", "no/where.toml", "no/where.toml"},
      {"debug", "no/where.toml", "--headless", "--script", "s.toml"},
      {"why", "no/where.toml", "--pair", "a", "b"},
      {"mesh", "no/where.toml"},
      {"diff", "no/where.toml", "no/where.toml"},
      {"shrink", "no/where.toml", "--when", "contacts > 0"},
      {"clean", "no/where.toml"},
      {"test", "no/where.toml"},
      {"sweep", "no/where.toml", "--vary", "contact.friction=0,1", "--out", "out"}};
  for (const std::vector<std::string>& words : commands) {
    CAPTURE(words);
    const Outcome outcome = impinge_run(folder.path(), words);
    INFO(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.error_lines() == 1);
    CHECK(outcome.err.find("no/where.toml: there is no such f") != std::string::npos);
  }
}
