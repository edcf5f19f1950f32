// Figures on the command line: their list, and folders that an older version wrote, whose tables have fewer columns.
#include <fmt/format.h>

#include "tests/support/program/debug_session.hpp"

using namespace impinge;
using namespace impinge::test;
namespace fs = std::filesystem;

namespace {

/// The table without the columns from `asleep` on, as a version wrote it that had no such figures.
void make_older(const TempFolder& folder, const std::string& stats) {
  std::istringstream in(slurp(folder / stats));
  std::string out, line;
  std::getline(in, line);
  const std::string rest = line.substr(line.find(",asleep"));
  const auto columns = std::count(rest.begin(), rest.end(), ',');
  for (bool more = true; more; more = static_cast<bool>(std::getline(in, line))) {
    for (auto i = columns; i > 0; --i) line.resize(line.rfind(','));
    out += line + "\n";
  }
  folder.write(stats, out);
}

std::string first_line(const fs::path& file) {
  const std::string text = slurp(file);
  return text.substr(0, text.find('\n'));
}

Outcome run(const TempFolder& folder, const std::string& out, int frames, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"run",     "s.toml",     "--out", out, "--frames", std::to_string(frames),
                                    "--quiet", "--no-images"};
  words.insert(words.end(), more.begin(), more.end());
  return impinge_run(folder.path(), words);
}

}  // namespace

TEST_CASE("the list of figures has a line for each column of stats.csv, in the table's order") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  REQUIRE(run(folder, "a", 1, {"--judge"}).code == 0);
  const Outcome list = impinge_run(folder.path(), {"list", "figures"});
  REQUIRE(list.code == 0);
  std::istringstream lines(list.out);
  std::string line, names;
  std::getline(lines, line);
  CHECK(line.starts_with("column "));
  while (std::getline(lines, line))
    if (!line.starts_with(' '))  // what goes on from the line before
      names += (names.empty() ? "" : ",") + line.substr(0, line.find(' '));
  CHECK(names == first_line(folder / "a/stats.csv"));

  const Outcome wrong = impinge_run(folder.path(), {"list", "figure"});
  CHECK(wrong.code == 2);
  CHECK(wrong.err.find("did you mean 'figures'?") != std::string::npos);
  const Outcome help = impinge_run(folder.path(), {"list", "--help"});
  CHECK(help.out.find("linear_solvers|cases|figures") != std::string::npos);
}

TEST_CASE("a folder whose table has fewer columns is read, and goes on with them") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  REQUIRE(run(folder, "old", 20).code == 0);
  REQUIRE(run(folder, "new", 30).code == 0);
  make_older(folder, "old/stats.csv");
  const std::string header = first_line(folder / "old/stats.csv");
  REQUIRE(header.find("asleep") == std::string::npos);

  CHECK(impinge_run(folder.path(), {"replay", "old"}).code == 0);
  const Outcome compared = impinge_run(folder.path(), {"compare", "old", "new"});
  CHECK(compared.code == 0);
  CHECK(compared.out.find("21 frames compared, every state hash is the same") != std::string::npos);
  folder.write("a.script", "panel plot +asleep\nseek 15\n");
  const Outcome shown = debug(folder, "old", "a.script");
  INFO(shown.err);
  CHECK(shown.code == 0);
  CHECK(end_of(shown) == std::pair(15, hash_in(folder / "new/stats.csv", 15)));

  REQUIRE(run(folder, "old", 30, {"--resume"}).code == 0);
  CHECK(first_line(folder / "old/stats.csv") == header);
  CHECK(hash_in(folder / "old/stats.csv", 30) == hash_in(folder / "new/stats.csv", 30));
  CHECK(impinge_run(folder.path(), {"replay", "old"}).code == 0);
}

TEST_CASE("a run that ended is compared by what both tables have") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  REQUIRE(run(folder, "old", 20).code == 0);
  REQUIRE(run(folder, "new", 20, {"--set", "contact.friction=0.1"}).code == 0);
  for (const char* side : {"old", "new"}) {
    make_older(folder, fmt::format("{}/stats.csv", side));
    REQUIRE(impinge_run(folder.path(), {"compare", "old", "new", "--out", side}).code == 1);
    const std::string columns = first_line(folder / fmt::format("{}/difference.csv", side));
    CHECK(columns.find("abs_unconverged") != std::string::npos);
    CHECK(columns.find("abs_asleep") == std::string::npos);
  }
}
