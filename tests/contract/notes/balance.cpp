// What a run says of energy that nobody gave, and of attachments that came apart; and that it says nothing where all is
// right.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/program/program.hpp"
#include "tests/support/program/sweep_results.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/notes/energy_rise.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kWeight = 1000.0 * 1e-6 * 9.81;  // N, of the cube below

/// A soft cube of 1 cm that falls on a floor from 1 cm above it, with `more` in its material.
std::string soft_cube(const std::string& more) {
  return "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n"
         "[[body]]\nname = \"cube\"\nkind = \"deformable\"\nshape = { box = { size = [0.01, 0.01, 0.01] } }\n"
         "volume = { lattice = { cells = 2 } }\nposition = [0, 0.015, 0]\n"
         "material = { young = 1e5, poisson = 0.3, density = 1000" +
         more + " }\n";
}

constexpr const char* kPendulum =
    "[[body]]\nname = \"bob\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.1 } }\nmass = 1\n"
    "position = [1, 0, 0]\n[[attachment]]\nname = \"pin\"\nbody_a = \"bob\"\npoint = [0, 0, 0]\n";

/// The same ball on a hand that goes down through the floor below it.
constexpr const char* kPulledApart =
    "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n"
    "[[body]]\nname = \"bob\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.1 } }\nmass = 1\n"
    "position = [0, 0.3, 0]\n"
    "[[body]]\nname = \"hand\"\nkind = \"scripted\"\nshape = { sphere = { radius = 0.02 } }\n"
    "motion = [ { time = 0, position = [0, 0.3, 0] }, { time = 1, position = [0, -0.3, 0] } ]\n"
    "[[attachment]]\nname = \"pin\"\nbody_a = \"bob\"\nbody_b = \"hand\"\npoint = [0, 0.3, 0]\ncollide = false\n";

/// A run of s.toml into o, and what it said.
struct Told {
  TempFolder folder;
  std::string out;
  std::vector<Row> rows;

  explicit Told(const std::string& scene, const std::vector<std::string>& more = {}, const std::string& script = "") {
    folder.write("s.toml", scene);
    folder.write("s.script", script);
    out = run(120, more);
    rows = csv_rows(folder / "o/stats.csv");
  }
  std::string run(int frames, const std::vector<std::string>& more) const {
    std::vector<std::string> words = {
        "run", "s.toml", "--script", "s.script", "--no-images", "--out", "o", "--frames", std::to_string(frames)};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = impinge_run(folder.path(), words);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return outcome.out;
  }
  /// The note that begins so, "" for none.
  std::string note(const std::string& begin) const {
    const std::size_t at = out.find("note:     " + begin);
    return at == std::string::npos ? "" : out.substr(at, out.find('\n', at) - at);
  }
  double energy(std::size_t frame) const {
    const Row& row = rows.at(frame);
    return std::stod(row.at("kinetic_J")) + std::stod(row.at("elastic_J")) + std::stod(row.at("potential_J"));
  }
};

constexpr const char* kEnergy = "energy that nobody gave";
const std::vector<std::string> kNewmark = {"--set", "simulation.integrator=newmark"};

FrameEnergy kinetic(int frame, double joule) { return {frame, joule, 0.0, 0.0}; }

}  // namespace

TEST_CASE("energy that a scheme makes in contact is told: since when, in which frame, and how much") {
  const Told told(soft_cube(""), kNewmark);
  const std::string note = told.note(kEnergy);
  INFO(told.out);
  REQUIRE(!note.empty());
  std::size_t worst = 0;
  for (std::size_t frame = 1; frame < told.rows.size(); ++frame)
    if (told.energy(frame) > told.energy(worst)) worst = frame;
  REQUIRE(told.energy(worst) - told.energy(0) > 100.0 * 0.01 * kWeight);  // of what it falls with
  int first = 0, named = 0;
  double rise = 0.0;
  REQUIRE(
      std::sscanf(note.c_str(),
                  "note:     energy that nobody gave: from frame %d on more than a tenth of what there was, most in "
                  "frame %d: %lf J",
                  &first, &named, &rise) == 3);
  CHECK(named == static_cast<int>(worst));
  CHECK(rise == Approx(told.energy(worst) - told.energy(0)).epsilon(0.01));
  CHECK(first >= 2);  // it lands in the third frame, after √(2 · 1 cm / g) = 45 ms
  CHECK(first <= named);
  // what it has at its start is 1 cm of fall, and as much is what a body that rests may have: a tenth of the two
  for (int frame = 0; frame < first; ++frame)
    CHECK(told.energy(static_cast<std::size_t>(frame)) - told.energy(0) < 0.1 * 2.0 * 0.01 * kWeight);
  CHECK(note.find("material.damping = [0, 0.0011]") != std::string::npos);
}

TEST_CASE("where no energy is won nothing is told: damped, by another integrator, or given by somebody") {
  for (const Told& told : {Told(soft_cube(", damping = [0, 0.00105]"), kNewmark), Told(soft_cube(""))}) {
    INFO(told.out);
    for (std::size_t frame = 1; frame < told.rows.size(); ++frame)
      CHECK(told.energy(frame) < told.energy(0) + 1e-3 * 0.01 * kWeight);
    CHECK(told.note("").empty());
  }
  // a push, a pull, and a gravity that turns round give what the energies then rise by
  for (const char* line : {"at 10 push cube 0 0.01 0\n", "at 10 pull cube 0 0.005 0 to 0 0.3 0 stiffness 1\n",
                           "at 10 set simulation.gravity 0 -100 0\n"}) {
    const Told told(soft_cube(", damping = [0, 0.005]"), {}, line);
    INFO(line << told.out);
    REQUIRE(told.energy(40) > told.energy(9) + 0.01 * kWeight);
    CHECK(told.note(kEnergy).empty());
  }
  // friction only takes: who changes it gives nothing, and what is won is told
  CHECK(!Told(soft_cube(""), kNewmark, "at 1 set contact.friction 0.3\n").note(kEnergy).empty());
}

TEST_CASE("a run that goes on tells of energy as one that was made at once") {
  const Told whole(soft_cube(""), kNewmark);
  Told parts(soft_cube(""), kNewmark);
  std::vector<std::string> anew = kNewmark, on = kNewmark;
  anew.emplace_back("--force");
  on.emplace_back("--resume");
  parts.run(1, anew);
  parts.out = parts.run(120, on);
  REQUIRE(!whole.note(kEnergy).empty());
  CHECK(parts.note(kEnergy) == whole.note(kEnergy));
}

TEST_CASE("a rise is one above the start, by a tenth of what there was") {
  const auto found = [](const std::vector<double>& joules) {
    std::vector<FrameEnergy> frames;
    for (const double joule : joules) frames.push_back(kinetic(static_cast<int>(frames.size()), joule));
    return find_energy_rise(frames, 0.0);
  };
  CHECK(!found({}));
  CHECK(!found(std::vector<double>(40, 1.0)));
  CHECK(!found({1, 1, 1, 1.09, 1.05, 1}));
  CHECK(!found({1, 0.1, 0.1, 1}));  // what was kept somewhere comes back
  const auto up = found({1, 1, 1.05, 1.11, 1.3, 1.2});
  REQUIRE(up);
  CHECK(up->first == 3);
  CHECK(up->worst == 4);
  CHECK(up->rise == Approx(0.3));
  CHECK(up->had == Approx(1.05));
  // what fell far has a tenth of that to gain, and of what it may have at rest
  const std::vector<FrameEnergy> fall = {{0, 0, 0, 10}, {1, 10, 0, 0}, {2, 10.9, 0, 0}, {3, 5, 6.2, 0}};
  const auto bounce = find_energy_rise(fall, 0.0);
  REQUIRE(bounce);
  CHECK(bounce->first == 3);
  CHECK(bounce->had == Approx(10.9));
  CHECK(!find_energy_rise(fall, 2.0));
}

TEST_CASE("an attachment that comes apart is named, with frame and gap, and one that holds is not") {
  const Told torn(kPulledApart), held(kPendulum);
  INFO(torn.out);
  const std::string note = torn.note("'pin'");
  REQUIRE(!note.empty());
  int frame = 0;
  double gap = 0.0, percent = 0.0;
  REQUIRE(std::sscanf(note.c_str(), "note:     'pin' came apart in frame %d: by %lf m, %lf %% of 'hand'", &frame, &gap,
                      &percent) == 3);
  const auto error = [&](const Told& told, int at) {
    return std::stod(told.rows.at(static_cast<std::size_t>(at)).at("attachment_error_m"));
  };
  CHECK(gap == Approx(error(torn, frame)).epsilon(0.01));
  CHECK(gap > 0.1 * 0.04);  // the hand is 4 cm thick
  CHECK(percent == Approx(100.0 * gap / 0.04).epsilon(0.02).margin(0.5));
  CHECK(error(torn, frame - 1) <= 0.1 * 0.04);
  CHECK(note.find("simulation.substeps") != std::string::npos);
  for (int at = 0; at <= 120; ++at) CHECK(error(held, at) < 1e-3);
  CHECK(held.note("").empty());
}

TEST_CASE(
    "a soft body that its integrator swells while it turns is told of, with sub-steps that do no such thing it is "
    "not") {
  // a stiff cube of 20 cm that flies and turns by half a radian a frame, in four sub-steps
  const std::string scene =
      "[simulation]\ngravity = [0, 0, 0]\n"
      "[[body]]\nname = \"cube\"\nkind = \"deformable\"\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n"
      "volume = { lattice = { cells = 2 } }\nangular_velocity = [0, 0, 30]\n"
      "material = { young = 1e7, poisson = 0.45, density = 1000 }\n";
  const Told told(scene, {"--set", "simulation.substeps=4"});
  INFO(told.out);
  const std::string note = told.note("'cube' swells as it turns");
  REQUIRE(!note.empty());
  int frame = 0;
  double percent = 0.0, turn = 0.0, energy = 0.0;
  REQUIRE(std::sscanf(note.c_str(),
                      "note:     'cube' swells as it turns, in frame %d by %lf %% at %lf radians a sub-step: %lf J",
                      &frame, &percent, &turn, &energy) == 4);
  CHECK(turn == Approx(0.125).epsilon(0.05));
  CHECK(percent == Approx(0.78).epsilon(0.1));
  const double measured = std::stod(told.rows.at(static_cast<std::size_t>(frame)).at("elastic_J"));
  CHECK(energy == Approx(measured).epsilon(0.1));
  CHECK(Told(scene, {"--set", "simulation.substeps=64"}).note("'cube' swells").empty());
}
