// What a benchmark is told on its command line: read wholly, or refused, before anything runs.
#include "tests/support/program/bench_arguments.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/support/mechanics/methods.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge::test;
namespace fs = std::filesystem;

namespace {

/// As a benchmark declares its own.
struct Example {
  int boxes = 1000, threads = 2;
  double seconds = 1.5;
  std::string scene = "planes";
  std::vector<std::string> methods = {"quick", "penalty"};
  BenchArguments arguments{"bench_example", "Heaps of boxes: ms a frame."};

  Example() {
    arguments.number("boxes", boxes, {1, 5000}, "how many");
    arguments.number("--threads", threads, {1}, "how many");
    arguments.number("seconds", seconds, {0.0}, "s, how long it is watched");
    arguments.word("scene", scene, one_of({"planes", "walls"}), "what holds them");
    arguments.words("method", methods, one_of({"quick", "penalty", "soft"}), "responses");
  }
};

}  // namespace

TEST_CASE("a benchmark without arguments runs with its defaults") {
  Example of;
  CHECK(!of.arguments.read({}));
  CHECK(of.boxes == 1000);
  CHECK(of.methods == std::vector<std::string>{"quick", "penalty"});
}

TEST_CASE("a benchmark reads its arguments in their order, and options anywhere") {
  Example of;
  REQUIRE(!of.arguments.read({"12", "--threads", "4", "0.25", "walls", "soft", "quick"}));
  CHECK(of.boxes == 12);
  CHECK(of.threads == 4);
  CHECK(of.seconds == 0.25);
  CHECK(of.scene == "walls");
  CHECK(of.methods == std::vector<std::string>{"soft", "quick"});
}

TEST_CASE(
    "a benchmark that is asked for help says what it measures and takes, with units and defaults, and runs nothing") {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--help"}, {"-h"}, {"7", "--help"}, {"--nonsense", "--help"}}) {
    Example of;
    const auto ending = of.arguments.read(words);
    REQUIRE(ending);
    CHECK(ending->code == 0);
    for (const char* said : {"Heaps of boxes: ms a frame.", "bench_example [boxes] [--threads VALUE] [seconds]", "1000",
                             "a whole number from 1 to 5000", "s, how long", "1.5", "planes", "quick penalty"}) {
      CAPTURE(said, ending->text);
      CHECK(ending->text.find(said) != std::string::npos);
    }
    CHECK(of.boxes == 1000);
  }
}

TEST_CASE("a benchmark refuses what it can't read with one line that says what is allowed, and exit code 2") {
  struct Case {
    std::vector<std::string> words;
    const char *found, *allowed;
  };
  for (const Case& c : {Case{{"--halp"}, "'--halp'", "no option"},
                        {{"-x"}, "'-x'", "no option"},
                        {{"many"}, "'many'", "a whole number from 1 to 5000"},
                        {{"12x"}, "'12x'", "a whole number from 1 to 5000"},
                        {{""}, "''", "a whole number from 1 to 5000"},
                        {{"0"}, "'0'", "from 1"},
                        {{"-3"}, "'-3'", "from 1"},
                        {{"99999999999999"}, "'99999999999999'", "to 5000"},
                        {{"1.5"}, "'1.5'", "a whole number"},
                        {{"1", "nan"}, "'nan'", "a number of 0 or more"},
                        {{"1", "1e-2s"}, "'1e-2s'", "a number"},
                        {{"1", "1", "sea"}, "'sea'", "one of planes, walls"},
                        {{"--threads"}, "--threads", "its value"},
                        {{"--threads", "two"}, "'two'", "of 1 or more"},
                        {{"1", "1", "walls", "soft", "hard"}, "'hard'", "penalty"}}) {
    Example of;
    const auto ending = of.arguments.read(c.words);
    REQUIRE(ending);
    CAPTURE(ending->text);
    CHECK(ending->code == 2);
    CHECK(std::count(ending->text.begin(), ending->text.end(), '\n') == 1);
    CHECK(ending->text.find("bench_example: ") == 0);
    CHECK(ending->text.find(c.found) != std::string::npos);
    CHECK(ending->text.find(c.allowed) != std::string::npos);
    CHECK(ending->text.find("--help") != std::string::npos);
  }
  int count = 3;
  BenchArguments few("bench_few", "Little.");
  few.number("count", count, {}, "how many");
  const auto ending = few.read({"1", "2"});
  REQUIRE(ending);
  CHECK(ending->text.find("'2' is one argument too many") != std::string::npos);
}

TEST_CASE("texts of methods and of parameters are looked at before a benchmark runs") {
  for (const char* good : {"quick", "constraint_anticipation:projected_gauss_seidel",
                           "constraint_anticipation:automatic:1e-6", "constraint_anticipation:automatic:1e-6:30"})
    CHECK(method_fault(good, "frames") == "");
  for (const char* bad : {"", "quik", "quick:newton", "constraint_anticipation:automatic:small",
                          "constraint_anticipation:automatic:1e-6:0", "constraint_anticipation:automatic:1e-6:3:4"}) {
    CAPTURE(bad);
    CHECK(method_fault(bad, "frames") != "");
  }
  CHECK(row_fault("simulation.substeps=4") == "");
  for (const char* bad : {"simulation.substeps", "simulation.substeps=many", "simulation.substep=4"}) {
    CAPTURE(bad);
    CHECK(row_fault(bad) != "");
  }
  CHECK(file_fault("/nowhere/at.all") != "");
}

TEST_CASE("every benchmark reads its command line with the shared reader, first of all") {
  int programs = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(IMPINGE_SOURCE_DIR) / "tests/bench")) {
    const std::string text = slurp(entry.path()), name = entry.path().stem().string();
    CAPTURE(name);
    ++programs;
    const std::size_t begin = text.find("int main(int argc, char** argv) {");
    REQUIRE(begin != std::string::npos);
    const std::size_t declared = text.find("BenchArguments arguments(", begin);
    CHECK(declared != std::string::npos);
    CHECK(text.find("\"bench_" + name + "\"", declared) != std::string::npos);
    const std::size_t read = text.find("arguments.read_or_exit(argc, argv);", begin);
    REQUIRE(read != std::string::npos);
    CHECK(text.find("argv", read + 36) == std::string::npos);
    CHECK(text.find("argv[") == std::string::npos);
    CHECK(text.find("getenv") == std::string::npos);
    for (const char* prints : {"printf(", "fmt::print("}) {
      const std::size_t at = text.find(prints, begin);
      CHECK((at == std::string::npos || at > read));
    }
  }
  CHECK(programs > 20);
}
