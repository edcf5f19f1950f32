// What the recipes of engine/README.md and viewer/README.md promise, held by the program that was built by them: one file
// and one line, and everything knows the newcomer. What every method has to do is asked by test_extended "[methods]".
#include <catch2/catch.hpp>

#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"

using namespace impinge::test;

namespace {

Outcome extended(const TempFolder& folder, const std::vector<std::string>& arguments) {
  return program_run(IMPINGE_EXTENDED_PROGRAM, folder.path(), arguments);
}

bool contains(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// The line of `text` that begins with a word, "" if there is none.
std::string line_of(const std::string& text, const std::string& word) {
  std::size_t begin = text.rfind(word, 0) == 0 ? 0 : text.find("\n" + word);
  if (begin == std::string::npos) return "";
  if (begin > 0) ++begin;
  return text.substr(begin, text.find('\n', begin) - begin);
}

/// The same with the lines below it that are indented.
std::string item_of(const std::string& text, const std::string& word) {
  std::string item = line_of(text, word);
  std::size_t end = text.find(item) + item.size();
  while (!item.empty() && text.compare(end, 2, "\n ") == 0) {
    const std::size_t next = std::min(text.find('\n', end + 1), text.size());
    item += text.substr(end, next - end);
    end = next;
  }
  return item;
}

struct Newcomer {
  const char *topic, *name, *path;  ///< of impinge list; where it is chosen, "" for none
};
constexpr Newcomer kNewcomers[] = {{"lcp_solvers", "symmetric_gauss_seidel", "lcp.method"},
                                   {"broad_phases", "sorted_axis", "broad_phase.method"},
                                   {"narrow_phases", "sorted_triangles", "narrow_phase.method"},
                                   {"responses", "relaxed_impulse", "response.method"},
                                   {"materials", "stiffening", ""},
                                   {"layers", "spin_axes", ""},
                                   {"shapes", "ellipsoid", ""}};

constexpr const char* kScene = R"(
[[body]]
name = "floor"
kind = "static"
shape = { box = { size = [1, 0.1, 1] } }
position = [0, -0.05, 0]
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [0.2, 0.2, 0.2] } }
material = { density = 500 }
position = [0.02, 0.12, 0]
angular_velocity = [0, 3, 1]
[[body]]
name = "jelly"
kind = "deformable"
shape = { box = { size = [0.2, 0.2, 0.2] } }
volume = { lattice = { cells = 2 } }
material = { model = "corotational", young = 1e4, damping = [0, 0.01] }
position = [0.4, 0.11, 0]
)";

/// The hash of the last frame.
std::string last_hash(const TempFolder& folder, const std::string& run) {
  const std::string table = slurp(folder / (run + "/stats.csv"));
  const std::size_t header_end = table.find('\n'), last = table.rfind('\n', table.size() - 2) + 1;
  const std::string header = table.substr(0, header_end), row = table.substr(last);
  std::size_t column = 0, begin = 0;
  for (const std::size_t at = header.find("state_hash"); begin < at; begin = header.find(',', begin) + 1) ++column;
  begin = 0;
  for (std::size_t k = 0; k < column; ++k) begin = row.find(',', begin) + 1;
  return row.substr(begin, 16);
}

}  // namespace

TEST_CASE("extension: every newcomer is listed, and chosen by scene, --set and script") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  for (const Newcomer& n : kNewcomers) {
    CAPTURE(n.topic, n.name);
    const Outcome list = extended(folder, {"list", n.topic});
    REQUIRE(list.code == 0);
    CHECK(line_of(list.out, n.name).size() > std::string(n.name).size() + 10);  // its name and what it is
    CHECK(line_of(impinge_run(folder.path(), {"list", n.topic}).out, n.name).empty());
    const std::string path = n.path;
    if (path.empty()) continue;
    const std::size_t dot = path.find('.');
    folder.write("scene_key.toml",
                 "[" + path.substr(0, dot) + "]\n" + path.substr(dot + 1) + " = \"" + n.name + "\"\n" + kScene);
    folder.write("by.script", "at 0 set " + path + " " + n.name + "\n");
    const std::vector<std::string> end = {"--frames", "12", "--no-images", "--quiet"};
    const auto run = [&](std::vector<std::string> words) {
      words.insert(words.end(), end.begin(), end.end());
      const Outcome outcome = extended(folder, words);
      CAPTURE(outcome.err);
      REQUIRE(outcome.code == 0);
    };
    run({"run", "scene_key.toml", "--out", std::string(n.name) + "_key"});
    run({"run", "s.toml", "--set", path + "=" + n.name, "--out", std::string(n.name) + "_set"});
    run({"run", "s.toml", "--script", "by.script", "--out", std::string(n.name) + "_script"});
    const std::string hash = last_hash(folder, std::string(n.name) + "_key");
    CHECK(hash.size() == 16);
    CHECK(last_hash(folder, std::string(n.name) + "_set") == hash);
    CHECK(last_hash(folder, std::string(n.name) + "_script") == hash);
    CHECK(
        contains(slurp(folder / (std::string(n.name) + "_key/run.toml")), "method = \"" + std::string(n.name) + "\""));
    // the program without the line knows nothing of it
    check_refused(folder, {"run", "scene_key.toml", "--frames", "1", "--no-images", "--out", "x"},
                  "scene_key.toml:2:10: ", "is not known");
    const std::string near = std::string(n.name).substr(1);
    const Outcome slip = extended(folder, {"check", "s.toml", "--set", path + "=" + near});
    CHECK(slip.code == 2);
    CHECK(contains(slip.err, "did you mean '" + std::string(n.name) + "'?"));
  }
  // detection must not change what happens, whoever does it
  const Outcome plain =
      extended(folder, {"run", "s.toml", "--frames", "12", "--no-images", "--quiet", "--out", "plain"});
  REQUIRE(plain.code == 0);
  CHECK(last_hash(folder, "sorted_axis_key") == last_hash(folder, "plain"));
  CHECK(last_hash(folder, "sorted_triangles_key") == last_hash(folder, "plain"));
  CHECK(last_hash(folder, "relaxed_impulse_key") != last_hash(folder, "plain"));
}

TEST_CASE("extension: a response's parameter is a row like any other") {
  const TempFolder folder;
  folder.write("s.toml", "[response]\nmethod = \"relaxed_impulse\"\nrelaxed_impulse = { relaxation = 0.5 }\n" +
                             std::string(kScene));
  const Outcome rows = extended(folder, {"list", "parameters"});
  const std::string row = item_of(rows.out, "response.relaxed_impulse.relaxation");
  CHECK(contains(row, "[0.05, 1]"));
  CHECK(contains(row, "0.8"));
  CHECK(contains(row, "Part of the way that a sweep goes."));
  CHECK(contains(rows.out, "\nresponse.relaxed_impulse.iterations"));

  const auto described = [&](const std::vector<std::string>& overrides) {
    std::vector<std::string> words = {"info", "s.toml"};
    for (const std::string& set : overrides) words.insert(words.end(), {"--set", set});
    return line_of(extended(folder, words).out, "response:");
  };
  CHECK(described({}) == "response:     relaxed_impulse, relaxation 0.5, tolerance 1e-08, at most 300 sweeps");
  CHECK(described({"response.relaxed_impulse.relaxation=0.25", "response.relaxed_impulse.iterations=9"}) ==
        "response:     relaxed_impulse, relaxation 0.25, tolerance 1e-08, at most 9 sweeps");
  CHECK(described({"response.method=constraint_anticipation", "lcp.method=symmetric_gauss_seidel"}) ==
        "response:     constraint_anticipation with symmetric_gauss_seidel, tolerance 1e-08, at most 1000 iterations");

  folder.write("s.script",
               "at 3 set response.relaxed_impulse.relaxation 0.9\nfrom 5 to 8 ramp response.relaxed_impulse.relaxation "
               "0.9 0.3\n");
  const Outcome run = extended(folder, {"run", "s.toml", "--script", "s.script", "--frames", "12", "--no-images",
                                        "--freeze", "12", "--out", "r"});
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  CHECK(contains(slurp(folder / "r/run.toml"), "[response.relaxed_impulse]\nrelaxation = 0.5\niterations = 300\n"));
  CHECK(contains(slurp(folder / "r/commands.log"), "at 3 set response.relaxed_impulse.relaxation 0.9\n"));
  const Outcome again = extended(folder, {"run", "r/run.toml", "--frames", "12", "--no-images", "--out", "again"});
  REQUIRE(again.code == 0);
  CHECK(last_hash(folder, "again") == last_hash(folder, "r"));
  // a cap that is met is named by its path
  const Outcome capped = extended(folder, {"run", "s.toml", "--set", "response.relaxed_impulse.iterations=1",
                                           "--frames", "12", "--no-images", "--out", "capped"});
  CHECK(contains(capped.out, "response.relaxed_impulse.iterations"));

  const Outcome outside = extended(folder, {"check", "s.toml", "--set", "response.relaxed_impulse.relaxation=2"});
  CHECK(outside.code == 2);
  CHECK(contains(outside.err, "response.relaxed_impulse.relaxation; allowed: a real number in [0.05, 1]"));
  const Outcome slip = extended(folder, {"check", "s.toml", "--set", "response.relaxed_impulse.relaxatin=1"});
  CHECK(slip.code == 2);
  CHECK(contains(slip.err, "did you mean 'response.relaxed_impulse.relaxation'?"));

  // the frozen step holds its settings, and impinge step runs it as a method without a cone solver
  CHECK(contains(slurp(folder / "r/frozen/000012.step"), "\nresponse.relaxed_impulse.relaxation = 0.3\n"));
  const Outcome step =
      extended(folder, {"step", "r/frozen/000012.step", "--response", "relaxed_impulse,constraint_anticipation",
                        "--lcp", "symmetric_gauss_seidel", "--out", "methods"});
  CAPTURE(step.out, step.err);
  REQUIRE(step.code == 0);
  const std::string methods = slurp(folder / "methods/methods.csv");
  CHECK(contains(methods, "\nrelaxed_impulse,"));
  CHECK(contains(methods, "\nconstraint_anticipation-symmetric_gauss_seidel,"));
  CHECK(contains(step.out, "the run, relaxed_impulse with automatic"));
  // a program without it reads the step all the same, but can't be the run
  const Outcome without = impinge_run(folder.path(), {"step", "r/frozen/000012.step"});
  CHECK(without.code == 2);
  CHECK(contains(without.err, "r/frozen/000012.step: settings: 'relaxed_impulse' is not known"));

  const Outcome ablation = extended(folder, {"info", "s.toml", "--ablation", "--frames", "2"});
  CAPTURE(ablation.out, ablation.err);
  REQUIRE(ablation.code == 0);
  CHECK(contains(line_of(ablation.out, "solver by problem"), "no use here"));
  CHECK(contains(line_of(ablation.out, "contact tolerance"), "no use here"));
}

TEST_CASE("extension: a sweep varies a newcomer and its parameter") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const Outcome sweep = extended(
      folder, {"sweep", "s.toml", "--set", "response.method=relaxed_impulse", "--vary",
               "response.relaxed_impulse.relaxation=0.4,0.9", "--frames", "3", "--jobs", "1", "--out", "sweep"});
  CAPTURE(sweep.out, sweep.err);
  REQUIRE(sweep.code == 0);
  const std::string results = slurp(folder / "sweep/results.csv");
  CHECK(contains(results, "response.relaxed_impulse.relaxation"));
  CHECK(std::count(results.begin(), results.end(), '\n') == 3);
}

TEST_CASE("extension: a material's parameter is a key of its bodies, and a row of each") {
  const TempFolder folder;
  std::string scene = kScene;
  scene = replaced(scene, "model = \"corotational\"", "model = \"stiffening\", stiffening = 40");
  folder.write("s.toml", scene);
  CHECK(contains(line_of(extended(folder, {"list", "parameters"}).out, "body.DEFORMABLE.material.stiffening"),
                 "[0, 1000]"));
  const auto hash = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", "s.toml", "--frames", "12", "--no-images", "--quiet", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = extended(folder, words);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return last_hash(folder, out);
  };
  const std::string stiff = hash("a", {});
  CHECK(hash("b", {"--set", "body.jelly.material.stiffening=40"}) == stiff);
  CHECK(hash("c", {"--set", "body.jelly.material.stiffening=0"}) != stiff);
  folder.write("live.script", "at 4 set body.jelly.material.stiffening 0\n");
  CHECK(hash("d", {"--script", "live.script"}) != stiff);
  const Outcome outside = extended(folder, {"check", "s.toml", "--set", "body.jelly.material.stiffening=-1"});
  CHECK(outside.code == 2);
  CHECK(contains(outside.err, "body.jelly.material.stiffening; allowed: a real number in [0, 1000]"));
  // another material's settings may stand beside those in use
  CHECK(extended(folder, {"check", "s.toml", "--set", "body.jelly.material.model=linear"}).code == 0);
  check_refused(folder, {"check", "s.toml"}, "s.toml:", "unknown key 'stiffening'");
}

TEST_CASE("extension: a layer has its switch, its parameter and its marks") {
  const TempFolder folder;
  folder.write("s.toml",
               "[view]\nlayers = [\"meshes\", \"spin_axes\"]\nspin_axes = { length = 200 }\n" + std::string(kScene));
  folder.write("off.script", "at 0 layer -spin_axes\n");
  folder.write("short.script", "at 0 set view.spin_axes.length 1\n");
  const std::string rows = extended(folder, {"list", "parameters"}).out;
  CHECK(contains(line_of(rows, "view.layer.spin_axes"), "false"));
  CHECK(contains(line_of(rows, "view.spin_axes.length"), "px"));
  const auto picture = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", "s.toml", "--frames", "0", "--size", "160x120", "--quiet", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = extended(folder, words);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return slurp(folder / (out + "/frames/000000.png"));
  };
  const auto differ = [&](const std::string& a, const std::string& b) {
    return impinge_run(folder.path(), {"diff", a + "/frames/000000.png", b + "/frames/000000.png"}).code == 1;
  };
  picture("on", {});
  picture("off", {"--script", "off.script"});
  picture("by_switch", {"--set", "view.layer.spin_axes=false"});
  picture("short", {"--script", "short.script"});
  CHECK(differ("on", "off"));
  CHECK(differ("on", "short"));
  CHECK_FALSE(differ("off", "by_switch"));
}

TEST_CASE("extension: a new shape is read, rests, is held by deformable bodies and compounds, and is refused by name") {
  const TempFolder folder;
  const std::string floor =
      "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n";
  const std::string egg = "{ ellipsoid = { size = [0.3, 0.2, 0.4] } }";
  folder.write("s.toml",
               floor + "[[body]]\nname = \"egg\"\nkind = \"dynamic\"\nshape = " + egg +
                   "\nposition = [0, 0.1, 0]\n"
                   "[[body]]\nname = \"pair\"\nkind = \"dynamic\"\nshape = { compound = { parts = [{ shape = " +
                   egg +
                   " }, { shape = { box = { size = [0.1, 0.1, 0.1] } }, position = [0.2, 0, 0] }] } }\n"
                   "position = [1, 0.1, 0]\n"
                   "[[body]]\nname = \"jelly\"\nkind = \"deformable\"\nshape = " +
                   egg + "\nvolume = { cage = { cells = 3 } }\nmaterial = { young = 1e5 }\nposition = [2, 0.12, 0]\n");
  folder.write("s.script",
               "expect max_penetration_m < 1e-4 at 20\nexpect judged_penetration_m < 1e-3 at 20\n"
               "expect contacts >= 3 at 20\n");
  const Outcome run = extended(folder, {"run", "s.toml", "--script", "s.script", "--frames", "20", "--size", "64x36",
                                        "--judge", "--export", "ply", "--out", "r"});
  CAPTURE(run.out, run.err);
  CHECK(run.code == 0);
  CHECK(std::filesystem::exists(folder / "r/frames/000020.png"));
  check_refused(folder, {"check", "s.toml"}, "s.toml:8:11: ", "ellipsoid");
  const Outcome flat = extended(folder, {"check", "s.toml", "--set", "body.egg.shape.ellipsoid.size=[0.3,0,0.4]"});
  CHECK(flat.code == 2);
  CHECK(contains(flat.err, "[1e-6, 1e6] m"));
}
