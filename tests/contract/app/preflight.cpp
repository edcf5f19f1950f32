// What impinge check warns of: planted traps, each found by its code, with the right number, and by no other code.
#include <algorithm>

#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/traps.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

/// An icosphere's worth of triangles: a sphere whose mesh is fine enough to overlap like one.
std::string mesh_ball(const TempFolder& folder, const std::string& file, double radius) {
  folder.write(file, off_text(icosphere(3, radius)));
  return fmt::format("surface = \"{}\"\nmaterial = {{ density = 1000 }}", file);
}

}  // namespace

TEST_CASE("preflight: what starts in another is named with how deep, from a millimetre to a kilometre") {
  const TempFolder folder;
  for (const double size : {1e-3, 1e-2, 1.0, 1e2, 1e3}) {
    CAPTURE(size);
    check_trap(folder, {"two balls",
                        "start-overlap",
                        ball("left", size, {0, 0, 0}) + ball("right", size, {1.75 * size, 0, 0}),
                        {"'left'", "'right'"},
                        "start ",
                        0.25 * size});
    check_trap(folder, {"a ball in a ball",
                        "body-inside",
                        ball("shell", size, {0, 0, 0}) + ball("core", 0.2 * size, {0.1 * size, 0, 0}),
                        {"'core' lies wholly inside 'shell'"},
                        "inside 'shell', ",
                        size * (1.0 - 0.1 - 0.2),
                        {},
                        0.02});  // of the vertices that it is drawn with
  }
  check_trap(folder, {"a crate in the floor",
                      "start-overlap",
                      body("floor", "shape = { plane = { normal = [0, 1, 0], offset = 0 } }", "static") +
                          body("crate",
                               "shape = { box = { size = [1, 1, 1] } }\nmaterial = { density = 500 }\n"
                               "position = [0, 0.4, 0]"),
                      {"'floor'", "'crate'"},
                      "start ",
                      0.1});
  check_trap(folder, {"a crate below the floor",
                      "body-inside",
                      body("floor", "shape = { plane = { normal = [0, 1, 0], offset = 0 } }", "static") +
                          body("crate",
                               "shape = { box = { size = [1, 1, 1] } }\nmaterial = { density = 500 }\n"
                               "position = [0, -2, 0]"),
                      {"'crate' lies wholly below 'floor'"},
                      "below 'floor', ",
                      1.5});
}

TEST_CASE("preflight: meshes that start in another, and one wholly inside") {
  const TempFolder folder;
  const std::string large = mesh_ball(folder, "large.off", 1.0), small = mesh_ball(folder, "small.off", 0.2);
  check_trap(folder, {"two meshes",
                      "start-overlap",
                      body("left", large) + body("right", large + "\nposition = [1.8, 0, 0]"),
                      {"'left'", "'right'"},
                      "start ",
                      0.2,
                      {},
                      0.1});  // triangles are no sphere
  check_trap(folder, {"a mesh in a mesh",
                      "body-inside",
                      body("shell", large) + body("core", small + "\nposition = [0.3, 0, 0]"),
                      {"'core' lies wholly inside 'shell'"},
                      "inside 'shell', ",
                      0.5,
                      {},
                      0.05});
  // in one place every vertex of the one lies on the other's surface
  check_trap(folder, {"two meshes in one place",
                      "start-overlap",
                      body("one", large) + body("again", large),
                      {"'one'", "'again'"},
                      "start ",
                      1.0,  // the centre
                      {},
                      0.1});
  // a cavity is outside
  TriangleMesh hollow = icosphere(3, 1.0);
  const TriangleMesh cavity = icosphere(3, 0.8);
  const int first = static_cast<int>(hollow.vertices.size());
  hollow.vertices.insert(hollow.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
  for (const Triangle& t : cavity.triangles) hollow.triangles.push_back({t[0] + first, t[2] + first, t[1] + first});
  folder.write("hollow.off", off_text(hollow));
  folder.write("fine.toml", body("shell", "surface = \"hollow.off\"\nmaterial = { density = 1000 }") +
                                body("core", small + "\nposition = [0.3, 0, 0]"));
  const Outcome fine = impinge_run(folder.path(), {"check", "fine.toml"});
  CAPTURE(fine.out);
  CHECK(warnings_in(fine.out).empty());
}

TEST_CASE("preflight: ratios, thresholds, speeds and densities") {
  const TempFolder folder;
  const std::string crate = "shape = { box = { size = [1, 1, 1] } }\n";
  const auto pair = [&](double ratio) {
    return body("light", crate + "mass = 1") +
           body("heavy", crate + fmt::format("mass = {}\nposition = [0, 2, 0]", ratio));
  };
  const auto column = [](int count, double side) {
    std::string all;
    for (int i = 0; i < count; ++i)
      all += body(fmt::format("cube_{}", i), fmt::format("shape = {{ box = {{ size = [{0}, {0}, {0}] }} }}\nmass = 1\n"
                                                         "position = [0, {1}, 0]",
                                                         side, (i + 0.5) * side));
    return all;
  };
  const auto sheet = [](double thickness, double speed) {
    return body("sheet", fmt::format("shape = {{ box = {{ size = [1, {}, 1] }} }}", thickness), "static") +
           ball("bullet", 0.5, {0, 3, 0}, fmt::format("mass = 1\nvelocity = [0, {}, 0]", -speed));
  };
  const std::vector<Trap> traps = {
      {"heavy on light", "mass-ratio", pair(1e8), {"'heavy'", "'light'"}, "weighs ", 1e8},
      {"heavy on light, quickly",
       "mass-ratio",
       pair(1000),
       {"'heavy'", "quick"},
       "weighs ",
       1000,
       {"--set", "response.method=quick"}},
      {"small cubes, quickly",
       "long-substep",
       column(5, 0.01),
       {"'cube_0'", "quick", "simulation.substeps = 3"},
       "falls ",
       9.81 / 3600,
       {"--set", "response.method=quick", "--set", "simulation.substeps=1"}},
      {"dust and a mountain",
       "size-ratio",
       ball("dust", 1e-4, {0, 9e3, 0}, "mass = 1") + ball("mountain", 4e3, {0, 0, 0}, "mass = 2"),
       {"'mountain'", "'dust'"},
       "km, ",
       4e7},
      {"contacts at a distance",
       "coarse-threshold",
       ball("mite", 1e-3, {0, 1, 0}),
       {"'mite'", "activation_distance"},
       "is ",
       1e-3,
       {"--set", "contact.activation_distance=1e-3"}},
      {"nothing bounces",
       "coarse-threshold",
       ball("mite", 1e-6, {0, 1, 0}),
       {"restitution_threshold", "'mite'"},
       "restitution_threshold is ",
       0.1,
       {"--set", "contact.restitution_threshold=0.1"}},
      {"everything sleeps",
       "coarse-threshold",
       ball("pebble", 0.01, {0, 1, 0}),
       {"sleep_speed", "'pebble'"},
       "sleep_speed is ",
       0.5,
       {"--set", "simulation.sleep_speed=0.5"}},
      {"a bullet that nobody watches",
       "fast-body",
       sheet(0.002, 200),
       {"'bullet'", "'sheet'", "continuous"},
       "moves ",
       200.0 / 240.0,
       {"--set", "narrow_phase.continuous=off"}},
      {"a slow one at a foil",
       "fast-body",
       sheet(1e-5, 0.01),
       {"'bullet'", "'sheet'"},
       "moves ",
       0.01 / 240.0,
       {"--set", "narrow_phase.continuous=off"}},
      {"a bullet at springs",
       "fast-body",
       sheet(0.002, 200),
       {"'bullet'", "response.method"},
       "moves ",
       200.0 / 240.0,
       {"--set", "response.method=penalty"}},
      {"a stamp",
       "fast-body",
       body("stamp",
            "shape = { box = { size = [1, 0.1, 1] } }\n"
            "motion = [{ time = 0, position = [0, 9, 0] }, { time = 0.05, position = [0, 1, 0] }]",
            "scripted") +
           ball("egg", 0.02, {0, 0, 0}),
       {"'stamp'"},
       "or itself is ",
       0.04,
       {"--set", "narrow_phase.continuous=off"}},
      {"a stiff spring",
       "unstable-step",
       ball("bead", 0.01, {0, 1, 0}, "mass = 0.01"),
       {"'bead'"},
       "a spring of ",
       1e6,
       {"--set", "response.method=penalty", "--set", "response.penalty.form=explicit", "--set",
        "response.penalty.stiffness=1e6"}},
      {"a jelly tower",
       "own-weight",
       body("tower",
            "shape = { box = { size = [1, 3, 1] } }\nvolume = { lattice = { cells = 6 } }\n"
            "material = { young = 1e4, poisson = 0.3, density = 1000 }",
            "deformable"),
       {"'tower'"},
       "own weight, ",
       1000 * 9.81 * 3},
      {"water by default",
       "default-density",
       body("crate", "shape = { box = { size = [2, 3, 4] } }"),
       {"'crate'"},
       "makes it weigh ",
       24e3},
      {"a soft one of water",
       "default-density",
       body("jelly",
            "shape = { box = { size = [1, 1, 1] } }\nvolume = { lattice = { cells = 2 } }\n"
            "material = { young = 1e6 }",
            "deformable"),
       {"'jelly'"},
       "makes it weigh ",
       1000},
      {"looked past",
       "out-of-view",
       ball("seen", 0.1, {0, 0, 0}) + ball("lost", 0.1, {50, 0, 0}) +
           "[view]\ncamera = { eye = [0, 0, 2], target = [0, 0, 0] }\n",
       {"'lost'"}},
      {"behind the camera",
       "out-of-view",
       ball("seen", 0.1, {0, 0, 0}) + ball("lost", 0.1, {0, 0, 9}) +
           "[view]\ncamera = { eye = [0, 0, 2], target = [0, 0, 0] }\n",
       {"'lost' is behind"}},
      {"too small to be seen",
       "out-of-view",
       ball("mite", 1e-4, {0, 0, 0}) + "[view]\ncamera = { eye = [0, 0, 2], target = [0, 0, 0] }\n",
       {"'mite' covers"},
       "covers ",
       2e-4 / (2.0 * 2.0 * std::tan(20.0 * M_PI / 180.0) / 720.0),
       {},
       0.05},
  };
  for (const Trap& trap : traps) check_trap(folder, trap);
}

TEST_CASE("preflight: surfaces with odd triangles, and those that cross themselves") {
  const TempFolder folder;
  // every tenth triangle has one in its middle that is ten thousand times smaller
  TriangleMesh m = icosphere(3, 1.0);
  const std::size_t whole = m.triangles.size();
  for (std::size_t i = 0; i < whole; i += 10) {
    const Triangle t = m.triangles[i];
    const Vec3 corners[] = {m.vertices[t[0]], m.vertices[t[1]], m.vertices[t[2]]};
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    const int first = static_cast<int>(m.vertices.size());
    for (const Vec3& corner : corners) m.vertices.push_back(middle + 1e-4 * (corner - middle));
    m.triangles[i] = {first, first + 1, first + 2};
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      m.triangles.push_back({t[k], t[l], first + l});
      m.triangles.push_back({t[k], first + l, first + k});
    }
  }
  folder.write("fine.off", off_text(m));
  check_trap(folder, {"specks",
                      "triangle-sizes",
                      body("planet", "surface = \"fine.off\"\nmaterial = { density = 1 }"),
                      {"'planet'", "fine.off", fmt::format("{} of {} triangles", whole / 10, whole / 10 * 6 + whole)},
                      "median is ",
                      0.16,
                      {},
                      0.2});
  TriangleMesh comet = icosphere(3, 1.0);
  comet.vertices[0] *= 1000.0;
  const std::size_t tail =
      static_cast<std::size_t>(std::count_if(comet.triangles.begin(), comet.triangles.end(),
                                             [](const Triangle& t) { return t[0] == 0 || t[1] == 0 || t[2] == 0; }));
  folder.write("comet.off", off_text(comet));
  check_trap(folder, {"a vertex that flew off",
                      "triangle-sizes",
                      body("comet", "surface = \"comet.off\"\nscale = 1\nmaterial = { density = 1 }"),
                      {"'comet'", fmt::format("{} of {} triangles", tail, comet.triangles.size()), "larger"},
                      "times: ",
                      999.0,
                      {},
                      0.01});

  TriangleMesh bars = box(Vec3(0.5, 0.05, 0.05));
  const TriangleMesh other = box(Vec3(0.05, 0.3, 0.04));
  const int n = static_cast<int>(bars.vertices.size());
  for (const Vec3& v : other.vertices) bars.vertices.push_back(v + Vec3(0.02, 0.03, 0.01));
  for (const Triangle& x : other.triangles) bars.triangles.push_back({x[0] + n, x[1] + n, x[2] + n});
  folder.write("bars.off", off_text(bars));
  check_trap(folder, {"crossed bars",
                      "self-crossing",
                      body("bars",
                           "surface = \"bars.off\"\nvolume = { cage = { cells = 12 } }\nself_collision = true\n"
                           "material = { young = 1e6, density = 1000 }",
                           "deformable"),
                      {"28 pairs"}});
}

TEST_CASE("preflight: lengths that nobody's assets have, where the file doesn't say its unit") {
  const TempFolder folder;
  folder.write("dog.off", off_text(box({150.0, 100.0, 50.0})));
  folder.write("mite.off", off_text(box({1e-4, 1e-4, 2e-4})));
  const auto one = [](const std::string& file, const std::string& keys, const char* kind = "dynamic") {
    return body("it", fmt::format("surface = \"{}\"\nmass = 1\n{}", file, keys), kind);
  };
  check_trap(folder, {"millimetres taken for metres",
                      "odd-length",
                      one("dog.off", ""),
                      {"dog.off", "unit = \"mm\" or \"cm\""},
                      "'it' is ",
                      300.0});
  check_trap(folder, {"kilometres taken for metres",
                      "odd-length",
                      one("mite.off", ""),
                      {"mite.off", "unit = \"km\" or \"inch\""},
                      "'it' is ",
                      4e-4});
  const std::string ground = body("it", "surface = \"dog.off\"", "static");
  for (const std::string& scene : {one("dog.off", "unit = \"mm\""), one("dog.off", "scale = 1"), ground}) {
    folder.write("fine.toml", scene);
    CHECK(warnings_in(impinge_run(folder.path(), {"check", "fine.toml"}).out).empty());
  }
}

TEST_CASE("preflight: tetrahedra that are almost flat") {
  const TempFolder folder;
  // a corner of a cube, and on its slanted face a second tetrahedron that is hardly higher than its base
  const double h = 1e-3;
  const std::string text = fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 {0} {0} {0}\n$EndNodes\n"
      "$Elements\n2\n1 4 2 0 1 1 2 3 4\n2 4 2 0 1 2 3 4 5\n$EndElements\n",
      1.0 / 3.0 + h);
  folder.write("flat.msh", text);
  // apex above the middle of an equilateral triangle of side sqrt(2): its faces stand at atan(height / inner radius)
  const double angle = std::atan(h * std::sqrt(3.0) / (std::sqrt(2.0) / (2.0 * std::sqrt(3.0)))) * 180.0 / M_PI;
  check_trap(folder, {"an apex on its base",
                      "thin-tetrahedra",
                      body("it", "volume = \"flat.msh\"\nmaterial = { young = 1e6, density = 1000 }", "deformable"),
                      {"1 of 2 tetrahedra of 'it'"},
                      "number 1 one of ",
                      angle,
                      {},
                      0.05});
}

TEST_CASE("preflight: a scripted body that jumps between two keys") {
  const TempFolder folder;
  const auto pusher = [](double second) {
    return body(
        "pusher",
        fmt::format("shape = {{ box = {{ size = [0.1, 0.4, 1] }} }}\nmotion = [{{ time = 0, position = [-1.5, 0.25, 0] "
                    "}}, {{ time = 1, position = [-1.2, 0.25, 0] }}, {{ time = {}, position = [-0.75, 0.25, 0] }}, {{ "
                    "time = 3, position = [-0.5, 0.25, 0] }}]",
                    second),
        "scripted");
  };
  check_trap(folder, {"two keys 20 ms apart",
                      "sudden-motion",
                      pusher(1.02),
                      {"'pusher'", "keys 2 and 3", "from 1 s on", "75 times"},
                      "goes ",
                      0.45,
                      {}});
  folder.write("fine.toml", pusher(2.0));
  CHECK(warnings_in(impinge_run(folder.path(), {"check", "fine.toml"}).out).empty());
}

TEST_CASE("preflight: a code that is none is refused where it stands, and list has them all") {
  const TempFolder folder;
  folder.write("s.toml", "[check]\nsilence = [\"start-overlapp\"]\n" + ball("a", 1.0, {0, 0, 0}));
  for (const char* command : {"check", "run"}) {
    const Outcome outcome = impinge_run(folder.path(), {command, "s.toml"});
    CHECK(outcome.code == 2);
    CHECK(outcome.err.rfind("s.toml:2:", 0) == 0);
    CHECK(outcome.err.find("did you mean 'start-overlap'?") != std::string::npos);
  }
  folder.write("s.toml", "[check]\nsilence = [\"default-density\", \"start-overlap\"]\n" +
                             ball("a", 1.0, {0, 0, 0}, "friction = 0.1") + ball("b", 1.0, {1, 0, 0}));
  const Outcome outcome = impinge_run(folder.path(), {"check", "s.toml", "--strict"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.code == 0);
  CHECK(outcome.out.find("no problems found (2 silenced by check.silence)") != std::string::npos);
  // what a run records of it is read back
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--frames", "1", "--no-images", "--out", "r"}).code == 0);
  CHECK(impinge_run(folder.path(), {"check", "r/run.toml", "--strict"}).code == 0);
  const Outcome list = impinge_run(folder.path(), {"list", "warnings"});
  for (const char* code : {"start-overlap", "body-inside", "out-of-view", "slow-frame"})
    CHECK(list.out.find(std::string(code) + " ") != std::string::npos);
}

TEST_CASE("preflight: the scenes that come with the program have no warning") {
  const fs::path root = IMPINGE_SOURCE_DIR;
  int scenes = 0;
  for (const char* where : {"scenes", "tests/images/suite"})
    for (const auto& entry : fs::directory_iterator(root / where)) {
      if (entry.path().extension() != ".toml" || entry.path().stem().string().ends_with("_sweep")) continue;
      const Outcome outcome = impinge_run(root, {"check", entry.path().string(), "--strict"});
      CAPTURE(entry.path().string(), outcome.out, outcome.err);
      CHECK(outcome.code == 0);
      CHECK(outcome.out.find("no problems found\n") != std::string::npos);
      ++scenes;
    }
  CHECK(scenes >= 14);
}

TEST_CASE("preflight: of the scenes with a fault each it names those that can be seen beforehand") {
  const std::map<std::string, std::pair<std::string, std::string>> faults = {
      {"activation_distance", {"coarse-threshold", "'marble_0'"}},
      {"inside_solid", {"body-inside", "'red_ball'"}},
      {"inverted_element", {"own-weight", "'jelly'"}},
      {"mass_ratio", {"mass-ratio", "'heavy'"}},
      {"passed_sheet", {"fast-body", "'sheet'"}},
      {"start_overlap", {"start-overlap", "'right'"}},
      {"wrong_unit", {"size-ratio", "'bunny'"}}};
  for (const auto& [scene, wanted] : faults) {
    const Outcome outcome = impinge_run(IMPINGE_SOURCE_DIR, {"check", fmt::format("scenes/faults/{}.toml", scene)});
    CAPTURE(scene, outcome.out, outcome.err);
    REQUIRE(outcome.code == 0);
    const auto found = warnings_in(outcome.out);
    REQUIRE(found.contains(wanted.first));
    CHECK(found.find(wanted.first)->second.find(wanted.second) != std::string::npos);
  }
}

TEST_CASE("info tells size and mass of rigid bodies") {
  const TempFolder folder;
  folder.write("s.toml", body("floor", "shape = { plane = { normal = [0, 1, 0], offset = 0 } }", "static") +
                             body("crate",
                                  "shape = { box = { size = [2, 3, 4] } }\nmaterial = { density = 500 }\n"
                                  "position = [0, 5, 0]") +
                             ball("pea", 0.004, {0, 9, 0}));
  const Outcome outcome = impinge_run(folder.path(), {"info", "s.toml"});
  CAPTURE(outcome.out);
  REQUIRE(outcome.code == 0);
  CHECK(std::regex_search(outcome.out, std::regex("\n  floor +static +plane +without end\n")));
  CHECK(std::regex_search(outcome.out, std::regex("\n  crate +dynamic +box +2 m × 3 m × 4 m, size 2.77 m, 12 t\n")));
  CHECK(
      std::regex_search(outcome.out, std::regex("\n  pea +dynamic +sphere +8 mm × 8 mm × 8 mm, size 8 mm, 0.268 g\n")));
}
