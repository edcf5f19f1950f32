// Errors against a reference, each against a truth from elsewhere: formulas of the motion and of the scheme's own
// error.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <sstream>

#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kG = 9.81, kFrame = 1.0 / 60.0;
constexpr const char* kFloor =
    "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n";

std::string ball(const std::string& more) {
  return "[[body]]\nname = \"ball\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.5 } }\n" + more;
}

// root of the mean square of the times of frames 0 ... last
double rms_time(int last) {
  double squares = 0.0;
  for (int k = 0; k <= last; ++k) squares += k * k * kFrame * kFrame;
  return std::sqrt(squares / (last + 1));
}

}  // namespace

TEST_CASE("against the formula of free fall the error is the one that the scheme has") {
  // velocities first, then positions with the new ones: low by g h t / 2
  const SweepFiles files;
  files.folder.write("fall.toml", ball("position = [0, 50, 0]\nvelocity = [1, 2, 3]\n"));
  REQUIRE(files
              .run("out", {"--vary", "simulation.substeps=1,2,4", "--reference", "case:free_fall", "--frames", "30"},
                   "fall.toml")
              .code == 0);
  const std::vector<Row> rows = sweep_results(files.folder / "out");
  for (int i = 0; i < 3; ++i) {
    CHECK(std::stod(rows[i].at("error_rms_m")) == Approx(0.5 * kG * kFrame / (1 << i) * rms_time(30)).epsilon(1e-9));
    // a ball of diameter 1
    CHECK(std::stod(rows[i].at("error_relative")) ==
          Approx(std::stod(rows[i].at("error_rms_m")) / std::sqrt(3.0)).epsilon(1e-3));
    CHECK(std::stod(rows[i].at("window_s")) == Approx(0.5));
  }
  REQUIRE(files
              .run("short",
                   {"--vary", "simulation.substeps=1,2", "--reference", "case:free_fall", "--frames", "30", "--window",
                    "0.2"},
                   "fall.toml")
              .code == 0);
  CHECK(std::stod(sweep_results(files.folder / "short")[1].at("error_rms_m")) ==
        Approx(0.25 * kG * kFrame * rms_time(12)).epsilon(1e-9));
  CHECK(sweep_results(files.folder / "short")[1].at("window_reason") == "--window");
  // a floor ends the formula: fall of 1 m takes 0.4515 s
  files.folder.write("floor.toml", kFloor + ball("position = [0, 1.5, 0]\n"));
  REQUIRE(files
              .run("floor", {"--vary", "simulation.substeps=8,16", "--reference", "case:free_fall", "--frames", "60"},
                   "floor.toml")
              .code == 0);
  for (const Row& row : sweep_results(files.folder / "floor")) {
    CHECK(std::stod(row.at("window_s")) == Approx(std::sqrt(2 / kG)).margin(2.5 * kFrame));
    CHECK(row.at("window_reason").find("first contact") != std::string::npos);
  }
}

TEST_CASE("against the formulas of sliding and bouncing errors are those of the scheme and fall with the step") {
  const SweepFiles files;
  // friction brakes as gravity pulls: the position lags by a h t / 2 as long as the box slides
  files.folder.write("slide.toml", std::string("[contact]\nfriction = 0.3\n") + kFloor +
                                       "[[body]]\nname = \"box\"\nkind = \"dynamic\"\nshape = { box = { size = [1, "
                                       "0.2, 1] } }\nposition = [0, 0.1, 0]\nvelocity = [3, 0, 0]\n");
  REQUIRE(files
              .run("slide",
                   {"--vary", "simulation.substeps=1,2,4", "--reference", "case:sliding", "--window", "0.5", "--frames",
                    "90"},
                   "slide.toml")
              .code == 0);
  const std::vector<Row> slide = sweep_results(files.folder / "slide");
  for (int i = 0; i < 3; ++i)
    CHECK(std::stod(slide[i].at("error_rms_m")) ==
          Approx(0.5 * 0.3 * kG * kFrame / (1 << i) * rms_time(30)).epsilon(1e-3));
  // to the end: it stops after v0^2 / (2 mu g), so an error of more than a hundredth of that way is not the formula's
  REQUIRE(files
              .run("stop", {"--vary", "simulation.substeps=4,16", "--reference", "case:sliding", "--frames", "120"},
                   "slide.toml")
              .code == 0);
  const std::vector<Row> stop = sweep_results(files.folder / "stop");
  CHECK(std::stod(stop[0].at("error_rms_m")) < 0.01 * 9 / (2 * 0.3 * kG));
  CHECK(std::stod(stop[0].at("error_rms_m")) / std::stod(stop[1].at("error_rms_m")) == Approx(4.0).epsilon(0.2));

  files.folder.write("bounce.toml",
                     std::string("[contact]\nrestitution = 0.8\n") + kFloor + ball("position = [0, 1.5, 0]\n"));
  REQUIRE(files
              .run("bounce",
                   {"--vary", "simulation.substeps=4,16,64", "--reference", "case:bouncing", "--frames", "75"},
                   "bounce.toml")
              .code == 0);
  const std::vector<double> bounce = numbers(sweep_results(files.folder / "bounce"), "error_rms_m");
  CHECK(bounce[1] < 0.5 * bounce[0]);
  CHECK(bounce[2] < 0.5 * bounce[1]);
  CHECK(bounce[2] < 0.01);
}

TEST_CASE("the finest job of a sweep is the reference of those that share its other values") {
  const SweepFiles files;
  files.folder.write("fall.toml", ball("position = [0, 50, 0]\n"));
  REQUIRE(files
              .run("out",
                   {"--vary", "simulation.gravity=[0,-9.81,0],[0,-5,0]", "--vary", "simulation.substeps=1,8,2",
                    "--reference", "finest", "--frames", "12"},
                   "fall.toml")
              .code == 0);
  const std::vector<Row> rows = sweep_results(files.folder / "out");
  for (int i = 0; i < 6; ++i) {
    CHECK(rows[i].at("reference") == rows[i < 3 ? 1 : 4].at("hash"));
    const double g = i < 3 ? kG : 5.0, step = kFrame / (i % 3 == 0 ? 1 : i % 3 == 1 ? 8 : 2);
    CHECK(std::stod(rows[i].at("error_rms_m")) ==
          Approx(0.5 * g * rms_time(12) * (step - kFrame / 8)).epsilon(1e-9).margin(1e-14));
    // v is exact at the ends of steps: momentum is the same, and energy differs by that of the height
    CHECK(std::stod(rows[i].at("error_momentum_Ns")) == Approx(0).margin(1e-9));
    const double mass = 1000 * 4.0 / 3.0 * M_PI * 0.125;
    CHECK(std::stod(rows[i].at("error_energy_J")) ==
          Approx(mass * g * 0.5 * g * 12 * kFrame * (step - kFrame / 8)).epsilon(1e-6).margin(1e-6));
  }
  CHECK(slurp(files.folder / "out/summary.txt").find("smallest time step") != std::string::npos);
  const auto refused = [&](const std::vector<std::string>& more, const std::string& start,
                           const std::string& contains) {
    check_refused(files.folder, SweepFiles::words("no", more, "fall.toml"), start, contains);
  };
  refused({"--vary", "contact.friction=0,1", "--reference", "finest"},
          "--reference finest: ", "no time step is varied");
  refused({"--vary", "simulation.substeps=1,2", "--vary", "simulation.frame_time=0.01,0.02", "--filter",
           "simulation.substeps * 0.01 == simulation.frame_time", "--reference", "finest"},
          "--reference finest: ", "share the smallest time step");
  refused({"--vary", "simulation.substeps=1,2", "--reference", "finest", "--reference", "contact.friction=1"},
          "--reference finest: ", "beside another");
  refused({"--vary", "simulation.substeps=1,2", "--reference", "case:freefall"},
          "--reference case:freefall: ", "did you mean 'free_fall'?");
  refused({"--vary", "simulation.substeps=1,2", "--reference", "case:sliding"},
          "--reference case:sliding: ", "one dynamic box");
}

TEST_CASE("the contact force error is the difference of the weights that bodies rest with") {
  const SweepFiles files;
  files.folder.write("rest.toml", std::string(kFloor) +
                                      "[[body]]\nname = \"box\"\nkind = \"dynamic\"\nmass = 1\nshape = { box = { size "
                                      "= [1, 1, 1] } }\nposition = [0, 0.5, 0]\n");
  REQUIRE(files
              .run("out",
                   {"--vary", "body.box.mass=1,2,3", "--reference", "body.box.mass=3", "--frames", "20", "--set",
                    "simulation.substeps=3"},
                   "rest.toml")
              .code == 0);
  const std::vector<Row> rows = sweep_results(files.folder / "out");
  for (int i = 0; i < 3; ++i) {
    CHECK(std::stod(rows[i].at("error_force_N")) == Approx((2 - i) * kG).epsilon(1e-6).margin(1e-9));
    CHECK(std::stod(rows[i].at("error_force_relative")) == Approx((2 - i) / 3.0).epsilon(1e-6).margin(1e-9));
    CHECK(std::stod(rows[i].at("error_penetration_m")) == Approx(0).margin(1e-12));
  }
}

TEST_CASE("surfaces of other triangles are compared at the same material points") {
  // one tetrahedron thrown with a spin, its corners in three orders: the same motion, and no error but what the files'
  // digits make
  const SweepFiles files;
  const auto off = [](const std::vector<int>& order) {
    const double corners[4][3] = {{0.1, 0, 0}, {-0.1, 0, 0.1}, {-0.1, 0, -0.1}, {0, 0.2, 0}};
    const int faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    std::string text = "OFF\n4 4 0\n";
    std::vector<int> place(4);
    for (int i = 0; i < 4; ++i) {
      place[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])] = i;
      const double* x = corners[order[static_cast<std::size_t>(i)]];
      text += fmt::format("{} {} {}\n", x[0], x[1], x[2]);
    }
    for (const auto& f : faces)
      text += fmt::format("3 {} {} {}\n", place[static_cast<std::size_t>(f[0])], place[static_cast<std::size_t>(f[1])],
                          place[static_cast<std::size_t>(f[2])]);
    return text;
  };
  files.folder.write("a.off", off({0, 1, 2, 3}));
  files.folder.write("b.off", off({2, 0, 3, 1}));
  files.folder.write("large.off", replaced(off({2, 0, 3, 1}), "0 0.2 0", "0 0.4 0"));
  files.folder.write(
      "rock.toml",
      "[[body]]\nname = \"rock\"\nkind = \"dynamic\"\nsurface = \"a.off\"\nangular_velocity = [1, 2, 3]\n"
      "velocity = [1, 0, 0]\n");
  const std::vector<std::string> words = {"--vary",      "body.rock.surface=a.off,b.off,large.off",
                                          "--reference", "body.rock.surface=a.off",
                                          "--window",    "all",
                                          "--frames",    "20"};
  REQUIRE(files.run("out", words, "rock.toml").code == 0);
  const std::vector<Row> rows = sweep_results(files.folder / "out");
  CHECK(std::stod(rows[0].at("error_rms_m")) == 0.0);
  CHECK(std::stod(rows[1].at("error_rms_m")) < 1e-12);
  CHECK(rows[1].at("window_reason").find("nearest points at the start") != std::string::npos);
  CHECK(rows[2].at("error_rms_m").empty());
  CHECK(rows[2].at("window_reason").find("the surface of 'rock' begins up to") != std::string::npos);
}

TEST_CASE("boxes of more and more cells come nearer to the finest") {
  const SweepFiles files;
  files.folder.write(
      "beam.toml",
      "[simulation]\nsubsteps = 2\n[[body]]\nname = \"beam\"\nkind = \"deformable\"\nshape = { box = { "
      "size = [1, 0.2, 0.2] } }\nvolume = { lattice = { cells = 4 } }\nmaterial = { young = 5e5, poisson "
      "= 0.3, density = 1000, damping = [5, 0.05] }\nfixed = { box = { min = [-0.51, -1, -1], max = "
      "[-0.499, 1, 1] } }\n");
  const Outcome outcome = files.run("out",
                                    {"--vary", "body.beam.volume.lattice.cells=5,10", "--reference",
                                     "body.beam.volume.lattice.cells=15", "--window", "all", "--frames", "10"},
                                    "beam.toml");
  INFO(outcome.err << outcome.out);
  REQUIRE(outcome.code == 0);
  const std::vector<double> errors = numbers(sweep_results(files.folder / "out"), "error_rms_m");
  CHECK(errors[0] > 2.0 * errors[1]);
  CHECK(errors[1] > 0.0);
}

TEST_CASE("the automatic window ends where a start aside has grown as the scene's instability says") {
  // a ball on top of a ball, frictionless: theta'' = g / R theta with R the distance of the centres. The start is aside
  // by 1e-9 of the size in a direction whose level part is cos(1.2) of it; that part grows as cosh to 1e-3 of the size.
  const SweepFiles files;
  files.folder.write("top.toml",
                     "[simulation]\nsleeping = false\n[contact]\nfriction = 0\n[[body]]\nname = \"below\"\nkind = "
                     "\"static\"\nshape = { sphere = { radius = 0.15 } }\n"
                     "[[body]]\nname = \"above\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.05 } }\nposition "
                     "= [0, 0.2, 0]\n");
  const Outcome outcome = files.run(
      "out", {"--vary", "simulation.substeps=8,16", "--reference", "simulation.substeps=32", "--frames", "180"},
      "top.toml");
  INFO(outcome.err << outcome.out);
  REQUIRE(outcome.code == 0);
  const double rate = std::sqrt(kG / 0.2), level = std::cos(0.5 * M_PI * (3 - std::sqrt(5.0))),
               time = std::acosh(1e6 / level) / rate;
  for (const Row& row : sweep_results(files.folder / "out")) {
    CHECK(std::stod(row.at("window_s")) == Approx(time).epsilon(0.05));
    CHECK(row.at("window_reason").find("1e-9 scene sizes aside") != std::string::npos);
    CHECK(std::stod(row.at("error_rms_m")) < 1e-3);
  }
  CHECK(slurp(files.folder / "out/summary.txt").find("window: ") != std::string::npos);
  // said not to look, the error is taken to the end
  REQUIRE(files
              .run("all",
                   {"--vary", "simulation.substeps=8,16", "--reference", "simulation.substeps=32", "--frames", "180",
                    "--window", "all"},
                   "top.toml")
              .code == 0);
  CHECK(std::stod(sweep_results(files.folder / "all")[0].at("window_s")) == Approx(3.0));
}

TEST_CASE("the cases that are listed are those that a reference may name") {
  const SweepFiles files;
  const Outcome list = impinge_run(files.folder.path(), {"list", "cases"});
  CHECK(list.code == 0);
  std::istringstream lines(list.out);
  std::string names;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with(' '))  // a meaning that goes on
      names += (names.empty() ? "" : ", ") + line.substr(0, line.find(' '));
  CHECK(names == "free_fall, sliding, bouncing");
  CHECK(files.run("out", {"--vary", "simulation.substeps=1,2", "--reference", "case:none"})
            .err.find("allowed: " + names + ";") != std::string::npos);
}

TEST_CASE("a reference that diverges leaves the errors empty, says so, and is not a success") {
  const SweepFiles files;
  files.folder.write("wild.toml",
                     "[simulation]\nframe_time = 10\ngravity = [0, 0, 0]\n[[body]]\nname = \"box\"\nkind = "
                     "\"dynamic\"\nshape = { box = { size = [1, 1, 1] } }\n");
  const Outcome outcome = files.run("out",
                                    {"--vary", "simulation.gravity=[0,0,0],[0,1,0]", "--reference",
                                     "simulation.gravity=[0,1e4,0]", "--window", "all", "--frames", "1450"},
                                    "wild.toml");
  INFO(outcome.err);
  CHECK(outcome.code == 1);
  CHECK(outcome.out.find("is diverged: ") != std::string::npos);
  for (const Row& row : sweep_results(files.folder / "out")) {
    CHECK(row.at("status") == "done");
    CHECK(row.at("error_rms_m").empty());
    CHECK(row.at("window_reason").find("the reference " + row.at("reference").substr(0, 8) + " is diverged") !=
          std::string::npos);
  }
}
