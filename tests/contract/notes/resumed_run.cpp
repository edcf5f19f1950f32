// What a run says at its end doesn't depend on when it was interrupted.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <fstream>
#include <regex>

#include "tests/support/program/sweep_results.hpp"
#include "tests/support/program/twisted_strip.hpp"
#include "viewer/notes/note_archive.hpp"
#include "viewer/notes/run_notes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

/// A run's folder as a kill after a frame leaves it: states of later ones, half a row more, and no `done`.
void cut_after(const fs::path& run, int frame) {
  fs::remove(run / "done");
  for (const auto& entry : fs::directory_iterator(run / "snapshots"))
    if (std::stoi(entry.path().stem().string()) > frame) fs::remove(entry.path());
  REQUIRE(fs::exists(run / "snapshots" / fmt::format("{:06}.bin", frame)));
}

/// Without the lines that only one that goes on has.
std::string report_of(const std::string& out) { return std::regex_replace(out, std::regex("resumed: [^\n]*\n"), ""); }

/// It sinks through the floor by explicit springs that are too soft.
const std::string kTroubled = std::string(R"([simulation]
substeps = 1
[response]
method = "penalty"
[response.penalty]
form = "explicit"
stiffness = 1e5
)") + kTiltedBox;

struct Trouble {
  const char* file;
  int frames, cut;
  const char* says;
  std::vector<std::string> more;
};

}  // namespace

TEST_CASE("a run that goes on says at its end what a run says that was never interrupted") {
  const TempFolder folder;
  folder.write("troubled.toml", kTroubled);
  folder.write("strip.toml", twisted_strip(4.0));
  const std::string faults = IMPINGE_SOURCE_DIR "/scenes/faults/", minimal = IMPINGE_SOURCE_DIR "/scenes/minimal.toml";
  const std::string contradiction = faults + "contradiction.toml", ratio = faults + "mass_ratio.toml";
  const Trouble scenes[] = {{"troubled.toml", 20, 15, "energy that nobody gave: from frame 3 on", {"--judge"}},
                            {contradiction.c_str(), 30, 26, "came apart in frame 22", {}},
                            {ratio.c_str(), 24, 18, "group solves in", {}},
                            {"strip.toml",
                             30,
                             26,
                             "crosses itself from frame",
                             {"--set", "simulation.substeps=1", "--set", "narrow_phase.continuous=off"}}};
  for (const Trouble& scene : scenes) {
    CAPTURE(scene.file);
    std::vector<std::string> words = {"run",   scene.file, "--no-images", "--frames", std::to_string(scene.frames),
                                      "--out", "o"};
    words.insert(words.end(), scene.more.begin(), scene.more.end());
    const Outcome whole = impinge_run(folder.path(), words);
    INFO(whole.out << whole.err);
    CHECK(whole.out.find(scene.says) != std::string::npos);
    cut_after(folder / "o", scene.cut);
    words.emplace_back("--resume");
    const Outcome resumed = impinge_run(folder.path(), words);
    CHECK(resumed.code == whole.code);
    CHECK(resumed.out.find(fmt::format("resumed:  after frame {}", scene.cut)) != std::string::npos);
    CHECK(report_of(resumed.out) == whole.out);
    CHECK(resumed.err == whole.err);
    fs::remove_all(folder / "o");
  }
}

TEST_CASE("a judged job that is interrupted and goes on is in doubt as it is without") {
  const SweepFiles files;
  files.folder.write("troubled.toml", kTroubled);
  const std::vector<std::string> words = {"--vary", "response.method=penalty,constraint_anticipation", "--judge",
                                          "--frames", "20"};
  REQUIRE(files.run("out", words, "troubled.toml").code == 0);
  const std::vector<Row> before = sweep_results(files.folder / "out");
  REQUIRE(before.size() == 2);
  CHECK_FALSE(before[0].at("doubts").empty());
  CHECK(before[1].at("doubts").empty());
  for (const Row& row : before) {
    fs::remove(files.job("out", row) / "done");
    cut_after(files.job("out", row) / "run", 15);
  }
  REQUIRE(files.run("out", words, "troubled.toml").code == 0);
  const std::vector<Row> after = sweep_results(files.folder / "out");
  REQUIRE(after.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(after[i].at("doubts") == before[i].at("doubts"));
    CHECK(after[i].at("state_hash") == before[i].at("state_hash"));
    CHECK(slurp(files.job("out", after[i]) / "output.txt").find("resumed:  after frame 15") != std::string::npos);
  }
}

TEST_CASE("states without notes are resumed from, and what rows tell is said") {
  const TempFolder folder;
  folder.write("troubled.toml", kTroubled);
  std::vector<std::string> words = {"run", "troubled.toml", "--no-images", "--frames", "20", "--out", "o", "--judge"};
  REQUIRE(impinge_run(folder.path(), words).code == 0);
  cut_after(folder / "o", 15);
  const fs::path last = folder / "o/snapshots/000015.bin";
  // as they were before: no notes and no number of their bytes
  constexpr std::size_t kHead = 19;
  const std::string bytes = slurp(last);
  REQUIRE(bytes.rfind("impinge snapshot 5\n", 0) == 0);
  ByteReader in(std::string_view(bytes).substr(kHead));
  std::string state;
  for (std::size_t size = 0; state.empty() && size + 8 < bytes.size() - kHead - 8; ++size) {
    const std::string_view rest = std::string_view(bytes).substr(kHead + size, bytes.size() - kHead - 8 - size);
    ByteReader number(rest);
    if (number.get<std::uint64_t>() == rest.size() - 8 && rest.size() > 8) state = bytes.substr(kHead, size);
  }
  REQUIRE_FALSE(state.empty());
  ByteWriter checksum;
  checksum.put(hash_bytes(state));
  std::ofstream(last, std::ios::binary) << "impinge snapshot 4\n" << state << checksum.bytes();
  words.emplace_back("--resume");
  const Outcome resumed = impinge_run(folder.path(), words);
  INFO(resumed.out << resumed.err);
  CHECK(resumed.code == 0);
  CHECK(resumed.out.find("resumed:  after frame 15") != std::string::npos);
}

TEST_CASE("what a note knows comes back from bytes, and damaged bytes are refused") {
  FrameStats stats;
  stats.frame = 3;
  stats.substeps = 2;
  stats.unsafe_motions = 1;
  stats.unsafe = {{"a", "b", UnsafeBody::unwatched, 2, 0.5, 0.5, 0.01, true}};
  stats.crossing = {"a", "b", 0.2, 1.0, 0};
  stats.unconverged = 4;
  stats.unsolved = {{SolveEnd::cap, "lcp.max_iterations", 4}};
  stats.unsolved_residual = 1.0, stats.residual = 0.25, stats.merged_impacts = 2;
  RunNotes notes;
  notes.watchdog.add(stats);
  notes.convergence.add(stats);
  notes.told = {"note: frame 3: one", ""};
  const std::string saved = notes.saved();
  RunNotes back;
  back.restore(saved);
  for (RunNotes* each : {&notes, &back}) each->watchdog.set_judged(true);
  CHECK(back.text() == notes.text());
  CHECK(back.watchdog.closing_line() == notes.watchdog.closing_line());
  CHECK(back.told == notes.told);
  CHECK(notes.text().find("passed through 'b' in frame 3, sub-step 2") != std::string::npos);
  CHECK(notes.text().find("4 group solves in 1 frame stopped at lcp.max_iterations") != std::string::npos);
  for (std::size_t size = 1; size < saved.size(); ++size)
    CHECK_THROWS_AS(RunNotes().restore(std::string_view(saved).substr(0, size)), InputError);
}
