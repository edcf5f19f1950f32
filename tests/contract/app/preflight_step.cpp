// What impinge check says of the sub-step: how long a stable one is, and what one takes.
#include <algorithm>
#include <sstream>

#include "tests/support/program/sweep_results.hpp"
#include "tests/support/program/traps.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("preflight: the sub-step that it says is stable is, and a longer one is not") {
  const TempFolder folder;
  for (const char* more : {"", ", damping = [0, 1e-4]", ", mass = \"consistent\""})
    for (const double size : {1e-2, 1.0, 1e2}) {
      CAPTURE(more, size);
      // its foot is moved by a thousandth of it, which stirs every mode a little
      folder.write(
          "soft.toml",
          fmt::format("[simulation]\nintegrator = \"symplectic_euler\"\nframe_time = {}\nsubsteps = 1\n"
                      "gravity = [0, 0, 0]\n",
                      0.1 * size) +
              body("jelly",
                   fmt::format("shape = {{ box = {{ size = [{0}, {0}, {0}] }} }}\nvolume = {{ lattice = {{ "
                               "cells = 3 }} }}\nangular_velocity = [0, 0, 0]\nvelocity = [0, 0, 0]\n"
                               "fixed = {{ box = {{ min = [-1e6, -1e6, -1e6], max = [1e6, {1}, 1e6] }}, motion = "
                               "[{{ time = 0 }}, {{ time = {2}, position = [0, {3}, 0] }}] }}\n"
                               "material = {{ model = \"linear\", young = 1e6, poisson = 0.3, density = 1000{4} "
                               "}}",
                               size, -0.49 * size, 1e-3 * size, 1e-3 * size, more),
                   "deformable"));
      const Outcome outcome = impinge_run(folder.path(), {"check", "soft.toml"});
      CAPTURE(outcome.out, outcome.err);
      REQUIRE(outcome.code == 0);
      const double most = quantity_after(outcome.out, "up to sub-steps of ");
      REQUIRE(most > 0.0);
      const auto energy_after = [&](double step) -> double {
        const Outcome run =
            impinge_run(folder.path(), {"run", "soft.toml", "--set", fmt::format("simulation.frame_time={}", step),
                                        "--frames", "401", "--no-images", "--quiet", "--out", "run", "--force"});
        if (run.code == 3) return INFINITY;
        REQUIRE(run.code == 0);
        const std::string stats = slurp(folder / "run/stats.csv");
        const std::string header = stats.substr(0, stats.find('\n')),
                          last = stats.substr(stats.rfind('\n', stats.size() - 2) + 1);
        std::istringstream names(header), cells(last);
        for (std::string name, cell; std::getline(names, name, ',') && std::getline(cells, cell, ',');)
          if (name == "elastic_J") return std::stod(cell);
        return std::nan("");
      };
      const double calm = energy_after(0.97 * most);
      CHECK(std::isfinite(calm));
      CHECK(energy_after(1.03 * most) > 1e6 * calm);
    }
}

TEST_CASE("preflight: a trial tells time and memory, and what it did not solve") {
  const TempFolder folder;
  const std::string stack = body("floor", "shape = { plane = { normal = [0, 1, 0], offset = 0 } }", "static") +
                            body("a", "shape = { box = { size = [1, 1, 1] } }\nmass = 1\nposition = [0, 0.5, 0]") +
                            body("b", "shape = { box = { size = [1, 1, 1] } }\nmass = 1\nposition = [0.1, 1.5, 0]");
  folder.write("s.toml", stack);
  const Outcome outcome = impinge_run(folder.path(), {"check", "s.toml", "--trial"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(warnings_in(outcome.out).empty());
  const double step = quantity_after(outcome.out, "a sub-step takes "), frame = quantity_after(outcome.out, "4 about ");
  CHECK(step > 0.0);
  CHECK(frame == Approx(4.0 * step).epsilon(0.02));
  CHECK(quantity_after(outcome.out, "if it stays as it starts; ") > 1.0);  // MiB
  CHECK(outcome.out.find("\nahead: 120 frames in ") != std::string::npos);
  const Outcome plain = impinge_run(folder.path(), {"check", "s.toml"});
  CHECK(plain.out.find("trial:") == std::string::npos);

  // they meet in frame 4: before, a sub-step costs nothing
  const auto cloud = [](const char* name, double y) {
    return body(name,
                fmt::format("shape = {{ box = {{ size = [1, 1, 1] }} }}\nvolume = {{ lattice = {{ cells = 8 }} }}\n"
                            "material = {{ young = 1e5, poisson = 0.3, density = 1000 }}\n"
                            "position = [0, {}, 0]\nvelocity = [0, {}, 0]",
                            y, -10.0 * y),
                "deformable");
  };
  folder.write("later.toml", "[simulation]\ngravity = [0, 0, 0]\n" + cloud("a", 1.0) + cloud("b", -1.0));
  const Outcome later = impinge_run(folder.path(), {"check", "later.toml", "--trial"});
  CAPTURE(later.out);
  REQUIRE(later.code == 0);
  CHECK(quantity_after(later.out, ", the dearest, ") > 2.0);
  CHECK(quantity_after(later.out, ", the dearest, ") < 60.0);

  check_trap(folder, {"one sweep is too few",
                      "no-answer",
                      stack,
                      {"lcp.max_iterations"},
                      "",
                      NAN,
                      {"--trial", "--set", "lcp.method=projected_gauss_seidel", "--set", "lcp.max_iterations=1"}});
  const auto tower = [](int cells) {
    return body("tower",
                fmt::format("shape = {{ box = {{ size = [1, 1, 1] }} }}\nvolume = {{ lattice = {{ cells = {} }} }}\n"
                            "material = {{ young = 1e6, poisson = 0.3, density = 1000 }}",
                            cells),
                "deformable");
  };
  const std::string soft = tower(12);
  folder.write("soft.toml", soft);
  const Outcome soft_trial = impinge_run(folder.path(), {"check", "soft.toml", "--trial"});
  CAPTURE(soft_trial.out);
  check_trap(folder, {"a thousand sub-steps of 160,000 tetrahedra",  // a minute where ten seconds are too many
                      "slow-frame",
                      tower(32),
                      {"a frame takes about"},
                      "",
                      NAN,
                      {"--trial", "--set", "simulation.substeps=1000"}});
  const double mebibytes = quantity_after(soft_trial.out, "if it stays as it starts; ");
  REQUIRE(mebibytes > 10.0);
  check_trap(folder, {"a narrow room",
                      "much-memory",
                      soft,
                      {},
                      "",
                      NAN,
                      {"--trial", "--memory-limit", fmt::format("{:.0f}K", 1.1 * 1024.0 * mebibytes)}});
}

namespace {

/// Cubes of 0.1 m and 1 kg on points, level from the world on, the last one of `end` kg.
std::string hung_chain(int links, double end, bool is_held = true) {
  std::string scene = "[simulation]\nsleeping = false\n";
  for (int i = 0; i < links; ++i)
    scene += body(fmt::format("link_{}", i),
                  fmt::format("shape = {{ box = {{ size = [0.1, 0.1, 0.1] }} }}\nmass = {}\nposition = [{}, 0, 0]",
                              i + 1 == links ? end : 1.0, 0.05 + 0.1 * i));
  for (int i = is_held ? 0 : 1; i < links; ++i) {
    scene += fmt::format("[[attachment]]\nbody_a = \"link_{}\"\npoint = [{}, 0, 0]\n", i, 0.1 * i);
    if (i > 0) scene += fmt::format("body_b = \"link_{}\"\ncollide = false\n", i - 1);
  }
  return scene;
}

bool warns(const TempFolder& folder, const std::string& scene, const std::string& code,
           const std::vector<std::string>& more = {}) {
  folder.write("s.toml", scene);
  std::vector<std::string> words = {"check", "s.toml"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = impinge_run(folder.path(), words);
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  return warnings_in(outcome.out).contains(code);
}

}  // namespace

TEST_CASE("preflight: what hangs on a chain's links is told with the sub-steps that keep its energy, and they do") {
  const TempFolder folder;
  check_trap(folder, {"eight links and a weight",
                      "mass-ratio",
                      hung_chain(8, 300.0),
                      {"'link_1'", "'link_0'", "simulation.substeps = 19"},
                      "hang ",
                      305.0});
  struct Worst {
    double gap = 0.0, won = 0.0;  // metres; J, of 305 kg that fall by 0.8 m
  };
  const auto worst = [&](const char* substeps) {
    const Outcome run = impinge_run(folder.path(), {"run", "trap.toml", "--set", substeps, "--frames", "120",
                                                    "--no-images", "--out", "o", "--force"});
    REQUIRE(run.code == 0);
    Worst worst;
    for (const Row& row : csv_rows(folder / "o/stats.csv")) {
      worst.gap = std::max(worst.gap, std::stod(row.at("attachment_error_m")));
      worst.won = std::max(worst.won, std::stod(row.at("kinetic_J")) + std::stod(row.at("potential_J")));
    }
    return worst;
  };
  const Worst few = worst("simulation.substeps=4"), enough = worst("simulation.substeps=19");
  CHECK(few.gap < 0.01);  // a tenth of a link: pieces of sub-steps hold it
  CHECK(enough.gap < 0.001);
  CHECK(enough.won < 0.03 * 305.0 * 9.81 * 0.8);
  CHECK_FALSE(warns(folder, hung_chain(8, 300.0), "mass-ratio", {"--set", "simulation.substeps=19"}));
  CHECK_FALSE(warns(folder, hung_chain(8, 300.0), "mass-ratio", {"--set", "simulation.gravity=[0,0,0]"}));
  CHECK_FALSE(warns(folder, hung_chain(8, 1.0), "mass-ratio"));
  CHECK_FALSE(warns(folder, hung_chain(2, 1e4), "mass-ratio"));  // one light link turns with its load
  CHECK(warns(folder, hung_chain(3, 1e4), "mass-ratio"));
  // the heaviest holds the chain where nothing else does; where both ends are held nothing hangs
  CHECK_FALSE(warns(folder, hung_chain(8, 1e3, false), "mass-ratio"));
  CHECK_FALSE(
      warns(folder, hung_chain(8, 1e3) + "[[attachment]]\nbody_a = \"link_7\"\npoint = [0.8, 0, 0]\n", "mass-ratio"));
  // a weight at both ends, one of them the heavier
  const std::string crane = hung_chain(8, 300.0, false) + body("crane",
                                                               "shape = { box = { size = [1, 1, 1] } }\nmass = 1e4\n"
                                                               "position = [-0.5, 0, 0]");
  CHECK(warns(folder, crane + "[[attachment]]\nbody_a = \"crane\"\nbody_b = \"link_0\"\npoint = [0, 0, 0]\n",
              "mass-ratio"));
}

TEST_CASE("preflight: newmark without damping is told of by how often waves cross a soft body in a sub-step") {
  const TempFolder folder;
  const auto cube = [](double size, const std::string& more) {
    return "[simulation]\nintegrator = \"newmark\"\n" +
           body("jelly",
                fmt::format(
                    "shape = {{ box = {{ size = [{0}, {0}, {0}] }} }}\nvolume = {{ lattice = {{ cells = 2 }} }}\n"
                    "material = {{ young = 1e4, poisson = 0.3, density = 1000{1} }}",
                    size, more),
                "deformable");
  };
  check_trap(folder, {"a cube of a centimetre",
                      "undamped-newmark",
                      cube(0.01, ""),
                      {"'jelly'", "material.damping = [0, 0.0011]", "integrator"},
                      "thick, ",
                      std::sqrt(1e4 / 1000.0) / 240.0 / 0.01});
  check_trap(folder, {"damped too little", "undamped-newmark", cube(0.01, ", damping = [5, 0.00103]"), {"'jelly'"}});
  CHECK_FALSE(warns(folder, cube(0.01, ", damping = [0, 0.00105]"), "undamped-newmark"));
  CHECK_FALSE(warns(folder, cube(0.01, ""), "undamped-newmark", {"--set", "simulation.integrator=implicit_euler"}));
  CHECK(warns(folder, cube(0.01, ""), "undamped-newmark", {"--set", "simulation.integrator=energy_momentum"}));
  CHECK_FALSE(warns(folder, cube(0.067, ""), "undamped-newmark"));  // 0.197 crossings
  CHECK(warns(folder, cube(0.065, ""), "undamped-newmark"));
}

TEST_CASE("preflight: a scene without bodies is told what it lacks") {
  const TempFolder folder;
  check_trap(folder, {"nothing", "no-body", "[simulation]\nsubsteps = 2\n", {"[[body]]"}});
  folder.write("s.toml", ball("a", 1.0, {0, 0, 0}));
  const Outcome one = impinge_run(folder.path(), {"check", "s.toml"});
  CHECK(one.out.find(": 1 body, 0 surface files, no problems found\n") != std::string::npos);
}
