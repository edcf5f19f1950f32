// What impinge check says of the sub-step: how long a stable one is, and what one takes.
#include <sstream>

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
