// What a run says of bodies that may have passed one another, and what becomes of it under --strict.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/sweep_results.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/notes/watchdog_note.hpp"
#include "viewer/sweep/doubts.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kSpeed = 200.0, kThick = 0.01;  // m/s, m

/// A cube of 0.1 m that flies at a thin plate and begins 4 m above it. Every frame is one sub-step of 1/60 s.
std::string shot() {
  return fmt::format(
      "[simulation]\nsubsteps = 1\ngravity = [0, 0, 0]\n"
      "[[body]]\nname = \"plate\"\nkind = \"static\"\nsurface = \"plate.off\"\n"
      "[[body]]\nname = \"bullet\"\nkind = \"dynamic\"\nsurface = \"cube.off\"\n"
      "position = [0, 4, 0]\nvelocity = [0, {}, 0]\n",
      -kSpeed);
}

/// Two boxes of 0.2 m that overlap by `depth`.
std::string overlap(double depth) {
  return fmt::format(
      "[simulation]\ngravity = [0, 0, 0]\n[contact]\nmax_push_out = 1e-9\n"
      "[[body]]\nname = \"below\"\nkind = \"static\"\nshape = {{ box = {{ size = [0.4, 0.2, 0.4] }} }}\n"
      "[[body]]\nname = \"above\"\nkind = \"dynamic\"\nshape = {{ box = {{ size = [0.3, 0.2, 0.3] }} }}\n"
      "position = [0, {}, 0]\n",
      0.2 - depth);
}

/// A frame with one body that moved farther than is safe.
FrameStats unsafe_frame(int frame, int substeps, const UnsafeBody& body) {
  FrameStats stats;
  stats.frame = frame;
  stats.substeps = substeps;
  stats.unsafe_motions = 1;
  stats.unsafe = {body};
  return stats;
}

Outcome run(const std::string& scene, std::vector<std::string> more) {
  TempFolder folder;
  folder.write("s.toml", scene);
  folder.write("plate.off", off_text(box({0.5, 0.5 * kThick, 0.5}, {10, 1, 10})));
  folder.write("cube.off", off_text(box(Vec3::Constant(0.05))));
  std::vector<std::string> words = {"run", "s.toml", "--no-images", "--frames", "3", "--out", "o"};
  words.insert(words.end(), more.begin(), more.end());
  return impinge_run(folder.path(), words);
}

const std::vector<std::string> kOff = {"--set", "narrow_phase.continuous=off"};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::string last_line(const std::string& text) {
  if (text.size() < 2) return text;
  return text.substr(text.rfind('\n', text.size() - 2) + 1);
}

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

}  // namespace

TEST_CASE("plates that cross like an X overlap by half a thickness, though no vertex of either is in the other") {
  const TempFolder folder;
  folder.write("flat.off", off_text(box({0.5, 0.5 * kThick, 0.5})));
  folder.write("upright.off", off_text(box({0.5 * kThick, 0.5, 0.4})));
  folder.write("s.toml",
               "[simulation]\ngravity = [0, 0, 0]\n[contact]\nmax_push_out = 1e-9\n"
               "[[body]]\nname = \"flat\"\nkind = \"static\"\nsurface = \"flat.off\"\n"
               "[[body]]\nname = \"upright\"\nkind = \"dynamic\"\nsurface = \"upright.off\"\n");
  const Outcome outcome = impinge_run(
      folder.path(), {"run", "s.toml", "--no-images", "--frames", "1", "--out", "o", "--judge", "--strict"});
  INFO(outcome.out);
  CHECK(outcome.code == 1);
  CHECK(says(last_line(outcome.out), "'flat' and 'upright' overlap by 0.005 m, 50 % of 0.01 m"));
}

TEST_CASE("a body that moved farther than is safe is named with frame, sub-step, displacement and remedy") {
  const Outcome outcome = run(shot(), kOff);
  INFO(outcome.out);
  CHECK(outcome.code == 0);
  CHECK(says(outcome.out, "'bullet'"));
  CHECK(says(outcome.out, "'plate'"));
  CHECK(says(outcome.out, "frame 2"));  // from 4 - 200/60 = 0.67 to -2.67 m
  CHECK(says(outcome.out, "sub-step 1"));
  CHECK(says(outcome.out, fmt::format("{:.3g} m", kSpeed / 60.0)));
  CHECK(says(outcome.out, fmt::format("{:.3g} m are safe", 0.1 * kThick)));
  CHECK(says(outcome.out, "narrow_phase.continuous"));
  // sub-steps so short that they are safe: the way over what is safe
  CHECK(says(outcome.out,
             fmt::format("divide simulation.frame_time by {:.0f}", std::ceil(kSpeed / 60.0 / (0.1 * kThick)))));
}

TEST_CASE("the sub-steps that the note asks for are as many as make the motion safe") {
  WatchdogNote note;
  CHECK(note.text().empty());
  CHECK(note.closing_line().empty());
  note.add(unsafe_frame(7, 4, {"a", "b", UnsafeBody::soft_contact, 3, 0.3, 0.5, 0.011, false}));
  CHECK(note.text() ==
        "note:     'a' moved 0.3 m beside 'b' in frame 7, sub-step 3 and may have passed it, 0.011 m are safe; choose "
        "a response.method that lets nothing overlap, or simulation.substeps = 182\n");  // 4 * 0.5 / 0.011 = 181.8
  CHECK(note.closing_line() == "watch:    'a' may have passed 'b' in frame 7, sub-step 3; --judge tells whether\n");
  CHECK(note.has_barked());
}

TEST_CASE("a body that was held back is said to have stood still, not to have passed") {
  WatchdogNote note;
  note.add(unsafe_frame(7, 4, {"a", "b", UnsafeBody::held_back, 3, 0.3, 0.5, 0.011, false}));
  CHECK(note.text() ==
        "note:     'a' stood still before 'b' in frame 7, sub-step 3, where it would have moved 0.3 m and through, "
        "0.011 m are safe; the sub-step was cut as often as it may be: take more simulation.substeps\n");
  CHECK(note.closing_line() == "watch:    'a' was held back from 'b' in frame 7, sub-step 3\n");
  CHECK(note.has_barked());
}

TEST_CASE("what was named is what helps") {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, std::vector<std::string>{"--set", "narrow_phase.continuous=on"}}) {
    const Outcome outcome = run(shot(), with(more, {"--strict", "--judge"}));
    INFO(outcome.out);
    CHECK(outcome.code == 0);
    CHECK_FALSE(says(outcome.out, "note: "));
    CHECK(last_line(outcome.out) == "judge:    nothing passed, nothing overlaps by more than 10 % of a thickness\n");
  }
}

TEST_CASE("a pass is a warning, and the end of a strict run") {
  CHECK(run(shot(), kOff).code == 0);
  const Outcome outcome = run(shot(), with(kOff, {"--strict"}));
  CHECK(outcome.code == 1);
  CHECK(says(last_line(outcome.out), "'bullet'"));
  const Outcome quiet = run(shot(), with(kOff, {"--strict", "--quiet"}));  // an exit code without a word is no answer
  CHECK(quiet.code == 1);
  CHECK(quiet.out.empty());
  CHECK(says(quiet.err, "'bullet'"));
  CHECK(quiet.error_lines() == 1);
  CHECK(run(shot(), with(kOff, {"--quiet"})).err.empty());
}

TEST_CASE("the judge tells who passed from who only moved too far") {
  const Outcome passed = run(shot(), with(kOff, {"--judge"}));
  INFO(passed.out);
  CHECK(passed.code == 0);
  CHECK(says(last_line(passed.out), "judge:    'bullet' passed through 'plate' in frame 2, sub-step 1"));

  // beside the plate, so near that the boxes of their ways meet
  std::string beside = shot();
  const std::string place = "position = [0, 4, 0]", other = "position = [0.56, 4, 0.56]";
  beside.replace(beside.find(place), place.size(), other);
  const Outcome missed = run(beside, with(kOff, {"--judge"}));
  INFO(missed.out);
  CHECK_FALSE(says(missed.out, "passed through"));
  CHECK(says(missed.out, "'bullet' moved"));
}

TEST_CASE("the judge's closing line names an overlap of more than 10 % of a thickness") {
  for (const char* judge : {"--judge", "--judge=substeps"}) {
    CAPTURE(judge);
    const Outcome deep = run(overlap(0.03), {judge});
    INFO(deep.out);
    CHECK(deep.code == 0);
    const std::string line = last_line(deep.out);
    CHECK(says(line, "'below' and 'above' overlap by 0.03 m, 15 % of 0.2 m, in frame 0"));
    CHECK(run(overlap(0.03), {judge, "--strict"}).code == 1);
    const Outcome shallow = run(overlap(0.018), {judge, "--strict"});
    CHECK(shallow.code == 0);
    CHECK(says(last_line(shallow.out), "nothing overlaps by more than 10 % of a thickness"));
  }
  // nobody looked, so nothing is said
  const Outcome unjudged = run(overlap(0.03), {"--strict"});
  CHECK(unjudged.code == 0);
  CHECK_FALSE(says(unjudged.out, "judge:"));
}

TEST_CASE("the option --judge takes substeps or nothing") {
  const Outcome outcome = run(overlap(0.01), {"--judge=frames"});
  CHECK(outcome.code == 2);
  CHECK(says(outcome.err, "--judge"));
  CHECK(says(outcome.err, "substeps"));
}

TEST_CASE("a run that is resumed is as strict about the frames before") {
  TempFolder folder;
  folder.write("s.toml", shot());
  folder.write("plate.off", off_text(box({0.5, 0.5 * kThick, 0.5}, {10, 1, 10})));
  folder.write("cube.off", off_text(box(Vec3::Constant(0.05))));
  std::vector<std::string> words = {
      "run", "s.toml", "--no-images", "--out", "o", "--set", "narrow_phase.continuous=off"};
  REQUIRE(impinge_run(folder.path(), with(words, {"--frames", "4"})).code == 0);
  const Outcome outcome = impinge_run(folder.path(), with(words, {"--frames", "6", "--resume", "--strict"}));
  INFO(outcome.out);
  CHECK(outcome.code == 1);
  // and says of them what a run says that was never interrupted
  const Outcome whole = impinge_run(folder.path(), {"run", "s.toml", "--no-images", "--out", "w", "--set",
                                                    "narrow_phase.continuous=off", "--frames", "6"});
  CHECK(last_line(outcome.out) == last_line(whole.out));
  CHECK(says(last_line(whole.out), "'bullet' may have passed 'plate' in frame 2, sub-step 1"));
}

TEST_CASE("the watch over frames of which only a number is left says so, and is a doubt") {
  WatchdogNote note;
  note.set_judged(true);
  note.add_earlier(1, 0.0);
  note.add_earlier(2, 3.0);
  CHECK(note.has_barked());
  CHECK(note.closing_line() ==
        "judge:    bodies may have passed others in 1 frame before the run was resumed, the first 2, nothing overlaps "
        "by more than 10 % of a thickness\n");
  const TempFolder folder;
  folder.write("output.txt", note.closing_line());
  CHECK(says(sweep_doubts(folder / "output.txt"), "may have passed others in 1 frame"));
  folder.write("output.txt", WatchdogNote().closing_line());
  CHECK(sweep_doubts(folder / "output.txt").empty());
}

TEST_CASE("of a body that passed on a way that is safe no number of sub-steps is promised") {
  WatchdogNote note;
  note.add(unsafe_frame(22, 1, {"a", "b", UnsafeBody::soft_contact, 1, 0.0151, 0.0151, 0.04, false}));
  CHECK(note.text() ==
        "note:     'a' moved 0.0151 m beside 'b' in frame 22, sub-step 1 and may have passed it; choose a "
        "response.method that lets nothing overlap, or take more simulation.substeps\n");
}

TEST_CASE("a frame judged by its sub-steps is the worst of as many frames of one sub-step") {
  TempFolder folder;
  // a soft response, so that there is overlap; powers of two, so that both have the same time step to the last bit
  folder.write("s.toml", R"([response]
method = "penalty"
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "strip"
kind = "deformable"
shape = { box = { size = [1, 0.05, 0.1] } }
volume = { cage = { cells = 12 } }
material = { young = 2e3, poisson = 0.3, density = 500 }
position = [0, 0.06, 0]
velocity = [0, -8, 0]
)");
  const auto run = [&](const std::string& name, const std::string& time, const std::string& substeps,
                       const std::string& frames, const std::string& judge) {
    const Outcome outcome =
        impinge_run(folder.path(), {"run", "s.toml", "--no-images", "--out", name, "--frames", frames, judge, "--set",
                                    "simulation.frame_time=" + time, "--set", "simulation.substeps=" + substeps});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return slurp(folder / (name + "/stats.csv"));
  };
  const auto column = [](const std::string& table, const std::string& name) {
    std::vector<double> values;
    std::istringstream lines(table);
    std::string line, cell;
    std::getline(lines, line);
    std::istringstream names(line);
    int place = -1, k = 0;
    for (; std::getline(names, cell, ','); ++k)
      if (cell == name) place = k;
    REQUIRE(place >= 0);
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      for (int i = 0; i <= place; ++i) std::getline(cells, cell, ',');
      values.push_back(std::stod(cell));
    }
    return values;
  };
  const std::string coarse = run("coarse", "0.015625", "4", "8", "--judge=substeps"),
                    fine = run("fine", "0.00390625", "1", "32", "--judge"),
                    ends = run("ends", "0.015625", "4", "8", "--judge");
  bool differs = false;
  for (const char* name : {"judged_penetration_m", "judged_intersections", "self_crossings"}) {
    const std::vector<double> by_frame = column(coarse, name), by_step = column(fine, name),
                              at_end = column(ends, name);
    REQUIRE((by_frame.size() == 9 && by_step.size() == 33));
    for (std::size_t k = 1; k < by_frame.size(); ++k) {
      CAPTURE(name, k);
      CHECK(by_frame[k] == *std::max_element(&by_step[4 * k - 3], &by_step[4 * k] + 1));
      differs |= by_frame[k] != at_end[k];
    }
  }
  CHECK(differs);  // else there was nothing to tell apart
  // run.toml repeats it
  CHECK(says(slurp(folder / "coarse/run.toml"), "judge_substeps = true"));
  REQUIRE(impinge_run(folder.path(), {"run", "coarse/run.toml", "--no-images", "--out", "again"}).code == 0);
  CHECK(column(slurp(folder / "again/stats.csv"), "judged_penetration_m") == column(coarse, "judged_penetration_m"));
  CHECK(impinge_run(folder.path(), {"replay", "coarse"}).code == 0);
}

TEST_CASE("the dragons on their posts overlap by less than a tenth of a millimetre, which is what is shown") {
  const TempFolder folder;
  REQUIRE(impinge_run(folder.path(),
                      {"run", IMPINGE_SOURCE_DIR "/scenes/dragon_stiffness.toml", "--set", "simulation.substeps=2",
                       "--frames", "24", "--no-images", "--judge", "--quiet", "--out", "run"})
              .code == 0);
  const std::vector<Row> rows = csv_rows(folder / "run/stats.csv");
  REQUIRE(rows.size() == 25);
  int overlapping = 0;
  for (const Row& row : rows) {
    const double truth = std::stod(row.at("judged_penetration_m")), shown = std::stod(row.at("max_penetration_m"));
    CAPTURE(row.at("frame"), truth, shown);
    CHECK(truth < 1e-4);
    CHECK(shown < 1e-4);
    CHECK(std::stod(row.at("substep_penetration_m")) < 1e-4);
    if (truth < 1e-6) continue;
    ++overlapping;
    CHECK(shown >= 0.5 * truth);
    CHECK(shown <= 2.0 * truth);
  }
  CHECK(overlapping > 3);
}

TEST_CASE("of bars that cross edge on edge the judge's column is the overlap, though no vertex is inside") {
  constexpr double kDepth = 0.02;  // of the edges; the faces stand at 45 degrees, so the way out is shorter
  TempFolder folder;
  folder.write("bar.off", off_text(box({0.5, 0.05, 0.05}, {9, 1, 1})));
  folder.write("s.toml", fmt::format("[simulation]\ngravity = [0, 0, 0]\nframe_time = 1e-4\n"
                                     "[[body]]\nname = \"low\"\nkind = \"static\"\nsurface = \"bar.off\"\n"
                                     "rotation = [45, 0, 0]\n[[body]]\nname = \"high\"\nkind = \"dynamic\"\n"
                                     "surface = \"bar.off\"\nposition = [0, {}, 0]\nrotation = [45, 90, 0]\n",
                                     0.1 * std::sqrt(2.0) - kDepth));
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--no-images", "--frames", "0", "--judge", "--out", "o"}).code ==
          0);
  const Row row = csv_rows(folder / "o/stats.csv").at(0);
  CHECK(std::stod(row.at("judged_depth_m")) == Approx(kDepth * std::sqrt(0.5)).epsilon(0.02));
  CHECK(std::stod(row.at("judged_penetration_m")) == 0.0);  // as it is agreed on: of vertices
}

TEST_CASE("what stood still to rounding is not told to have moved, the other one of the pair is") {
  WatchdogNote note;
  note.add(unsafe_frame(107, 4, {"still", "fast", UnsafeBody::soft_contact, 3, 5.57e-9, 0.00713, 0.04, false}));
  CHECK(note.text().empty());
  note.add(unsafe_frame(107, 4, {"fast", "still", UnsafeBody::soft_contact, 3, 0.00713, 0.00713, 0.04, false}));
  CHECK(note.text().find("'fast' moved 0.00713 m beside 'still'") != std::string::npos);
  CHECK(note.text().find("'still' moved") == std::string::npos);
}
