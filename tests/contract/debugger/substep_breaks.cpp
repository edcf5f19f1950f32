// Conditions of `break`, `expect` and `find` at sub-steps, against a run whose frames are the sub-steps of the other one:
// what its table says of frame 4 k + s is the truth of sub-step s of frame k + 1.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <map>
#include <sstream>

#include "tests/support/program/debug_session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::string scene(int substeps) {
  return fmt::format(R"([simulation]
substeps = {}
frame_time = {}
sleeping = false
[[body]]
name = "floor"
kind = "static"
shape = {{ plane = {{ normal = [0, 1, 0], offset = 0 }} }}
[[body]]
name = "crate-1"
kind = "dynamic"
shape = {{ box = {{ size = [1, 0.5, 1] }} }}
position = [0, 1.3, 0]
rotation = [10, 20, 0]
[[body]]
name = "ball"
kind = "dynamic"
shape = {{ sphere = {{ radius = 0.3 }} }}
position = [0.1, 2.3, 0]
velocity = [0, -1, 0]
)",
                     substeps, substeps / 256.0);
}

constexpr int kSubsteps = 4, kFrames = 40;

struct Files {
  TempFolder folder;
  std::vector<std::map<std::string, double>> fine;  ///< rows by frame of the fine run
  Files() {
    folder.write("s.toml", scene(kSubsteps));
    folder.write("fine.toml", scene(1));
    REQUIRE(impinge_run(folder.path(), {"run", "fine.toml", "--out", "fine", "--frames",
                                        std::to_string(kSubsteps * kFrames), "--no-images", "--contacts"})
                .code == 0);
    std::istringstream in(slurp(folder / "fine/stats.csv"));
    std::vector<std::string> names;
    for (std::string line; std::getline(in, line);) {
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (names.empty()) {
        names = cells;
        continue;
      }
      std::map<std::string, double>& values = fine.emplace_back();
      for (std::size_t i = 0; i < names.size(); ++i) values[names[i]] = std::atof(cells[i].c_str());
    }
    REQUIRE(fine.size() == kSubsteps * kFrames + 1);
  }
  /// "frame 12: stopped by break when CONDITION, sub-step 3 of 4": of the first row, from `from` on, that holds while the
  /// one before doesn't.
  std::string expected(const std::string& condition,
                       const std::function<bool(const std::map<std::string, double>&)>& holds, int from = 0) const {
    for (int i = from; i < static_cast<int>(fine.size()); ++i) {
      if (!holds(fine[static_cast<std::size_t>(i)]) || (i > 0 && holds(fine[static_cast<std::size_t>(i) - 1])))
        continue;
      const int frame = (i + kSubsteps - 1) / kSubsteps, substep = i - (frame - 1) * kSubsteps;
      std::string text = fmt::format("frame {}: stopped by break when {}", frame, condition);
      if (i > 0 && substep < kSubsteps) text += fmt::format(", sub-step {} of {}", substep, kSubsteps);
      return text;
    }
    return "";
  }
};

}  // namespace

TEST_CASE("a breakpoint stops at the sub-step with which it becomes true") {
  Files f;
  using Row = std::map<std::string, double>;
  const std::pair<std::string, std::function<bool(const Row&)>> conditions[] = {
      {"contacts > 0", [](const Row& r) { return r.at("contacts") > 0; }},
      {"kinetic_J < 500 && contacts > 0", [](const Row& r) { return r.at("kinetic_J") < 500 && r.at("contacts") > 0; }},
      {"contacts >= 4", [](const Row& r) { return r.at("contacts") >= 4; }},
      {"groups == 2", [](const Row& r) { return r.at("groups") == 2; }},
      {"momentum_y > -200 && time_s > 0.1",
       [](const Row& r) { return r.at("momentum_y") > -200 && r.at("time_s") > 0.1; }},
      {"time_s > 0.3", [](const Row& r) { return r.at("time_s") > 0.3; }}};
  int within = 0;
  for (const auto& [condition, holds] : conditions) {
    CAPTURE(condition);
    const std::string expected = f.expected(condition, holds);
    f.folder.write("a.script", "break when " + condition + "\n");
    std::filesystem::remove_all(f.folder / "out");
    const Outcome ran = impinge_run(f.folder.path(), {"run", "s.toml", "--script", "a.script", "--out", "out",
                                                      "--frames", std::to_string(kFrames), "--no-images"});
    INFO(ran.err);
    f.folder.write("b.script", "break when " + condition + "\nstep 40\n");
    const Outcome debugged = debug(f.folder, "s.toml", "b.script");
    INFO(debugged.err);
    if (expected.empty()) {
      CHECK(ran.code == 0);
      continue;
    }
    within += expected.find("sub-step") != std::string::npos;
    CHECK(ran.code == 1);
    CHECK(ran.err.find(expected + ";") != std::string::npos);
    CHECK(debugged.err.find(expected + ";") != std::string::npos);
    // the frame that it is in is whole
    const auto [frame, hash] = end_of(debugged);
    CHECK(expected.starts_with(fmt::format("frame {}:", frame)));
    CHECK(hash_in(f.folder / "out/stats.csv", frame) == hash);
    CHECK(hash_in(f.folder / "out/stats.csv", frame + 1).empty());
    // a run that goes on stops there again
    const Outcome resumed =
        impinge_run(f.folder.path(), {"run", "s.toml", "--script", "a.script", "--out", "out", "--frames",
                                      std::to_string(kFrames), "--no-images", "--resume"});
    CHECK(resumed.code == 1);
    CHECK(resumed.err.find(expected + ";") != std::string::npos);
    // found without having been looked for
    f.folder.write("c.script", "step 40\nfind " + condition + "\n");
    const Outcome found = debug(f.folder, "s.toml", "c.script");
    CHECK(found.out.substr(found.out.find(',')) == debugged.out.substr(debugged.out.find(',')));
    CHECK(end_of(found) == end_of(debugged));
  }
  CHECK(within >= 3);
}

TEST_CASE("bodies and pairs can be asked about by name") {
  Files f;
  std::istringstream in(slurp(f.folder / "fine/contacts.csv"));
  std::string line;
  std::getline(in, line);
  int first_crate = 0, first_pair = 0;
  while (std::getline(in, line)) {
    std::istringstream row(line);
    std::string frame, a, b;
    std::getline(row, frame, ','), std::getline(row, a, ','), std::getline(row, b, ',');
    if (a == "floor" && b == "crate-1" && first_crate == 0) first_crate = std::stoi(frame);
    if (a == "crate-1" && b == "ball" && first_pair == 0) first_pair = std::stoi(frame);
  }
  REQUIRE(first_crate > 0);
  REQUIRE(first_pair > 0);
  const auto stops_at = [&](const std::string& condition) {
    f.folder.write("a.script", "break when " + condition + "\nstep 40\n");
    const Outcome said = debug(f.folder, "s.toml", "a.script");
    INFO(condition << said.err << said.out);
    CHECK(said.code == 0);
    int frame = 0, substep = kSubsteps;
    std::sscanf(said.out.c_str(), "frame %d", &frame);
    if (const auto at = said.out.find("sub-step "); at != std::string::npos)
      substep = std::stoi(said.out.substr(at + 9));
    return (frame - 1) * kSubsteps + substep;
  };
  CHECK(stops_at("contacts(floor,crate-1) > 0") == first_crate);
  CHECK(stops_at("contacts(ball, crate-1) > 0") == first_pair);
  // a ball that falls freely: v = 1 + g t, by hand
  const double g = 9.81;
  const int steps = static_cast<int>(std::floor((2.0 - 1.0) / g * 256.0)) + 1;
  REQUIRE(steps < first_pair);
  CHECK(stops_at("speed(ball) > 2") == steps);
  // its distance from the floor is its height less its radius
  double y = 2.3, v = 1.0;
  int low = 0;
  while (y - 0.3 >= 1.8) v += g / 256, y -= v / 256, ++low;
  CHECK(stops_at("gap(floor,ball) < 1.8") == low);
  CHECK(stops_at("speed(ball) > 2 || contacts(crate-1,ball) > 0 && gap(ball,crate-1) < 0.1") == steps);
  CHECK(stops_at("depth(ball,crate-1) > 100") == 40 * kSubsteps);
  // energies of bodies sum to the row's
  f.folder.write("e.script",
                 "expect energy(ball) + energy(crate-1) + energy(floor) - kinetic_J - potential_J < 1e-6 at 9\n"
                 "expect kinetic_J + potential_J - energy(ball) - energy(crate-1) < 1e-6 at 9\n"
                 "expect energy(ball) < 0 at 9\n");
  const Outcome ran = impinge_run(
      f.folder.path(), {"run", "s.toml", "--script", "e.script", "--out", "e", "--frames", "12", "--no-images"});
  CHECK(ran.code == 1);
  CHECK(ran.error_lines() == 1);
  CHECK(ran.err.find("expected energy(ball) < 0; found energy(ball) = ") != std::string::npos);
  // and again when the run goes on, which has its figures only
  const Outcome again = impinge_run(f.folder.path(), {"run", "s.toml", "--script", "e.script", "--out", "e", "--frames",
                                                      "12", "--no-images", "--resume"});
  CHECK(again.err == ran.err);
}

TEST_CASE("breakpoints of the debugger: set, hit again, off, and what is wrong in them") {
  Files f;
  const auto said = [&](const std::string& lines) {
    f.folder.write("a.script", lines);
    return debug(f.folder, "s.toml", "a.script");
  };
  // within one frame, twice
  const Outcome twice = said("break when time_s > 0.1 && time_s < 0.105 || time_s > 0.107\nstep 40\nstep 40\n");
  CHECK(twice.err.find("hit 2") != std::string::npos);
  CHECK(std::count(twice.err.begin(), twice.err.end(), 0x0a) == 2);
  // set after frames were made, true from the moment it is set or not
  CHECK(end_of(said("step 20\nback 15\nbreak when time_s > 0.2\nstep 14\n")).first == 13);
  CHECK(end_of(said("step 20\nbreak when time_s > 0.2\nstep 10\n")).first == 30);
  CHECK(end_of(said("step 20\nback 15\nbreak when time_s > 0.2\nbreak off\nstep 14\n")).first == 19);
  // in the middle of a frame
  CHECK(end_of(said("step 12\nstep stage 3\nbreak when time_s > 0.2\nstep 14\n")).first == 13);
  CHECK(said("step 12\nbreak when time_s > 0.2\nstep stage 10000\n").err.find("frame 13: stopped") !=
        std::string::npos);

  const auto refused = [&](const std::string& line, const std::string& words) {
    CAPTURE(line);
    check_refused(said(line + "\n"), words);
  };
  refused("break when depth(bal,floor) > 0", "did you mean 'ball'?");
  refused("break when dept(ball,floor) > 0", "did you mean 'depth'?");
  refused("break when depth(ball) > 0", "asks of two bodies");
  refused("break when speed(ball,floor) > 0", "asks of one body");
  refused("break when contcts > 0", "did you mean 'contacts'?");
  refused("find", "find CONDITION is wanted");
  refused("break on", "allowed: when, off");
  refused("step stages", "did you mean 'stage'?");
  refused("back substep 0", "range");
}
