// The note at a run's end on solves without an answer: it names what ended them, and that alone.
#include <catch2/catch.hpp>

#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/notes/convergence_note.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Two boxes on a floor, off centre, and with `soft` the lower one deformable.
std::string stack(bool soft) {
  const std::string lower = soft ? "kind = \"deformable\"\nvolume = { cage = { cells = 2 } }\n"
                                   "material = { young = 1e5, poisson = 0.3, density = 500 }\n"
                                 : "kind = \"dynamic\"\n";
  return "[[body]]\nname = \"floor\"\nkind = \"static\"\n"
         "shape = { plane = { normal = [0, 1, 0], offset = 0 } }\n"
         "[[body]]\nname = \"lower\"\nshape = { box = { size = [0.2, 0.2, 0.2] } }\nposition = [0, 0.1, 0]\n" +
         lower +
         "[[body]]\nname = \"upper\"\nkind = \"dynamic\"\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n"
         "position = [0.03, 0.301, 0.02]\nvelocity = [0.5, -1, 0]\n";
}

std::string note_of(bool soft, std::vector<std::string> settings) {
  TempFolder folder;
  folder.write("s.toml", stack(soft));
  std::vector<std::string> words = {"run", "s.toml", "--no-images", "--frames", "6", "--out", "o"};
  for (std::string& text : settings) words.push_back("--set"), words.push_back(std::move(text));
  const Outcome outcome = impinge_run(folder.path(), words);
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const std::size_t begin = outcome.out.find("note: ");
  return begin == std::string::npos ? "" : outcome.out.substr(begin, outcome.out.find('\n', begin) - begin);
}

void check_names(const std::string& note, const std::string& parameter) {
  INFO(note);
  for (const char* path : {"lcp.max_iterations", "response.iterative_constraint_anticipation.max_iterations",
                           "response.sequential_impulse.iterations", "response.simultaneous_impulse.iterations"})
    CHECK((note.find(path) != std::string::npos) == (path == parameter));
}

}  // namespace

TEST_CASE("the note at a run's end names the parameter that stopped the solves, and no other") {
  for (const std::string method : {"sequential_impulse", "simultaneous_impulse"}) {
    const std::string path = "response." + method + ".iterations";
    check_names(note_of(false, {"response.method=" + method, path + "=1"}), path);
  }
  check_names(note_of(false, {"lcp.method=projected_gauss_seidel", "lcp.max_iterations=1"}), "lcp.max_iterations");
  const std::string iterative = "response.iterative_constraint_anticipation";
  for (const std::string form : {"accelerated", "seed"})
    check_names(note_of(true, {"response.method=iterative_constraint_anticipation", iterative + ".form=" + form,
                               iterative + ".max_iterations=1"}),
                iterative + ".max_iterations");
  // contacts are solved at each of its iterations, and nobody is told of a residual of theirs
  for (const std::string scheme : {"implicit_euler", "newmark", "energy_momentum"}) {
    const std::string note =
        note_of(true, {"simulation.integrator=" + scheme, "integrator." + scheme + ".max_iterations=1"});
    INFO(note);
    CHECK(note.find("stopped at the Newton iterations of simulation.integrator; motions don't balance their forces") !=
          std::string::npos);
  }
  // what was named is what helps
  CHECK(note_of(false, {"response.method=sequential_impulse", "response.sequential_impulse.iterations=100000",
                        "lcp.tolerance=1e-6"})
            .empty());
}

TEST_CASE("the note counts each cause for itself where there are several") {
  FrameStats stats;
  CHECK(ConvergenceNote().text().empty());
  ConvergenceNote note;
  stats.frame = 3;
  stats.unconverged = 1;
  stats.residual = 0.25;
  stats.unsolved = {{SolveEnd::cap, "lcp.max_iterations", 1}};
  stats.unsolved_residual = 1e-9;  // relative: as good as an answer
  note.add(stats);
  CHECK(note.text().empty());
  note = {};
  stats.unsolved_residual = 0.5;
  note.add(stats);
  CHECK(note.text() ==
        "note:     1 group solve in 1 frame stopped at lcp.max_iterations; the largest residual was 0.25 m/s in frame "
        "3\n");
  stats.frame = 4;
  stats.unconverged = 4;
  stats.residual = 0.125;
  stats.unsolved = {{SolveEnd::contradiction, "", 1}, {SolveEnd::cap, "lcp.max_iterations", 3}};
  note.add(stats);
  CHECK(note.text() ==
        "note:     5 group solves in 2 frames did not converge: 4 stopped at lcp.max_iterations, 1 had contacts that "
        "contradict each other; the largest residual was 0.25 m/s in frame 3\n");
}

TEST_CASE("the note says in how many sub-steps impacts were more than a sub-step is cut between") {
  const TempFolder folder;
  std::string scene = "[contact]\nrestitution = 1\nsuccessive_impacts = 1\n\n[simulation]\ngravity = [0, 0, 0]\n";
  for (int i = 0; i < 5; ++i)
    scene += fmt::format(
        "\n[[body]]\nname = \"ball_{}\"\nkind = \"dynamic\"\nshape = {{ sphere = {{ radius = 0.05 }} }}\n"
        "mass = 1\nposition = [{}, 0, 0]\nvelocity = [{}, 0, 0]\n",
        i, i * 0.1005 - (i == 0 ? 0.01 : 0.0), i == 0 ? 1 : 0);
  folder.write("cradle.toml", scene);
  const auto run = [&](const char* most) {
    const Outcome outcome =
        impinge_run(folder.path(), {"run", "cradle.toml", "--frames", "10", "--no-images", "--force", "--set",
                                    fmt::format("contact.successive_impacts={}", most)});
    CAPTURE(outcome.err);
    CHECK(outcome.code == 0);
    return outcome.out;
  };
  CHECK(run("1").find("note:     in 1 sub-step more impacts followed from one another than "
                      "contact.successive_impacts tells apart, the first in frame 1: ") != std::string::npos);
  CHECK(run("8").find("successive_impacts") == std::string::npos);
}
