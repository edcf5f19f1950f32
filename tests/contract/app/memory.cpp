// Memory is estimated before it is taken: refused above the limit with the number, which is what is taken otherwise.
#include <catch2/catch.hpp>
#include <fstream>

#include "tests/support/program/refusal.hpp"

using namespace impinge::test;

namespace {

std::string cube(const std::string& volume) {
  return "[[body]]\nname = \"cube\"\nkind = \"deformable\"\nshape = { box = { size = [1, 1, 1] } }\nvolume = " +
         volume + "\nmaterial = { young = 1e5 }\n";
}

/// The most that was resident, bytes.
double peak_of(const TempFolder& folder, const std::vector<std::string>& words) {
  double peak = 0.0;
  const Outcome outcome = impinge_watched(folder.path(), words, [&](pid_t pid) {
    std::ifstream status("/proc/" + std::to_string(pid) + "/status");
    for (std::string word; status >> word;)
      if (word == "VmHWM:" && status >> word) peak = std::max(peak, 1024.0 * std::stod(word));
  });
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  return peak;
}

/// "needs about 4.8 GiB" in bytes.
double needed(const std::string& message) {
  const std::size_t at = message.find("needs about ");
  REQUIRE(at != std::string::npos);
  std::istringstream words(message.substr(at + 12));
  double value = 0.0;
  std::string unit;
  words >> value >> unit;
  return value * (unit == "GiB" ? 1073741824.0 : unit == "MiB" ? 1048576.0 : 0.0);
}

}  // namespace

TEST_CASE("what a volume needs is estimated within a factor of 1.5 before it is taken, and refused above the limit") {
  TempFolder folder;
  for (const char* volume : {"{ lattice = { cells = 40 } }", "{ cage = { cells = 30 } }"}) {
    CAPTURE(volume);
    folder.write("s.toml", cube(volume));
    const Outcome refused = impinge_run(folder.path(), {"check", "s.toml", "--memory-limit", "100M"});
    CAPTURE(refused.err);
    CHECK(refused.code == 2);
    CHECK(refused.error_lines() == 1);
    CHECK(refused.err.rfind("s.toml:5:", 0) == 0);
    CHECK(refused.err.find("100 MiB are allowed (--memory-limit)") != std::string::npos);
    const double estimate = needed(refused.err), peak = peak_of(folder, {"check", "s.toml"});
    CAPTURE(estimate, peak);
    CHECK(peak < 1.5 * estimate);
    CHECK(estimate < 1.5 * peak);
  }
  // little text that asks for much: refused at once
  folder.write("s.toml", cube("{ cage = { cells = 200 } }"));
  check_refused(folder, {"run", "s.toml", "--out", "o", "--no-images", "--memory-limit", "2G"}, "s.toml:5:", "GiB");
  check_refused(folder, {"check", "s.toml", "--memory-limit", "plenty"}, "command line: ", "write --memory-limit 4G");
  // of a scene that asks for nothing large: less than the program holds by itself
  folder.write("s.toml",
               "[[body]]\nname = \"ball\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 1 } }\nmass = 1\n");
  for (const char* limit : {"1K", "100K", "1M"})
    check_refused(folder, {"check", "s.toml", "--memory-limit", limit}, "command line: ", "with nothing loaded");
  CHECK(impinge_run(folder.path(), {"check", "s.toml", "--memory-limit", "200M"}).code == 0);
}
