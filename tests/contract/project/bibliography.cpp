// Every tag that a comment or a page cites is in the bibliography of engine/README.md, and every entry there is cited.
#include <catch2/catch.hpp>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const std::string kHeading = "\n## References\n";

/// What people read of a file: of a source its comments, line after line, since a tag may stand on two.
std::string prose(const fs::path& file) {
  const std::string text = slurp(file);
  if (file.extension() == ".md") return text.substr(0, text.find(kHeading));
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t at = line.find("//"); at != std::string::npos) out += line.substr(at + 2) + ' ';
  return out;
}

/// Names with a year of two digits that stand in brackets: [Name99], [Name99 §3.1], [Name99, Other01; Third04].
std::set<std::string> tags_in(const std::string& text) {
  static const std::regex brackets(R"(\[([^\[\]]*)\])"), tag(R"(\b[A-Z][a-z]+[A-Za-z]*[0-9]{2}\b)");
  std::set<std::string> tags;
  for (std::sregex_iterator group(text.begin(), text.end(), brackets), end; group != end; ++group) {
    const std::string inner = (*group)[1];
    for (std::sregex_iterator it(inner.begin(), inner.end(), tag), none; it != none; ++it) tags.insert(it->str());
  }
  return tags;
}

}  // namespace

TEST_CASE("every tag that is cited is in the bibliography, and every entry there is cited") {
  const fs::path root = IMPINGE_SOURCE_DIR;
  std::map<std::string, std::string> cited;  // tag -> a file
  for (const char* folder : {"engine", "viewer", "tests", "shaders", "scenes"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string kind = entry.path().extension();
      if (!std::set<std::string>{".cpp", ".hpp", ".md", ".glsl", ".vert", ".frag"}.count(kind)) continue;
      if (entry.path().filename() == "bibliography.cpp") continue;
      for (const std::string& tag : tags_in(prose(entry.path()))) cited[tag] = fs::relative(entry.path(), root);
    }
  for (const std::string& tag : tags_in(slurp(root / "README.md"))) cited[tag] = "README.md";
  CHECK(cited.size() > 30);

  const std::string page = slurp(root / "engine/README.md");
  const std::size_t begin = page.find(kHeading);
  REQUIRE(begin != std::string::npos);
  // | [Tag] | authors: title. where, 2004 |
  static const std::regex form(R"(\| \[(\w+)\] \| [^:|]+: [^|]+\. [^|]+, ([0-9]{4}) \|)");
  std::istringstream lines(page.substr(begin + kHeading.size()));
  std::set<std::string> entries;
  std::string before;
  for (std::string line; std::getline(lines, line) && line.rfind("## ", 0) != 0;) {
    if (line.rfind("| [", 0) != 0) continue;
    INFO(line);
    std::smatch parts;
    REQUIRE(std::regex_match(line, parts, form));
    const std::string tag = parts[1];
    CHECK(tag.substr(tag.size() - 2) == parts[2].str().substr(2));  // the year
    CHECK(before < tag);                                            // in order
    before = tag;
    CHECK(entries.insert(tag).second);
    CHECK(cited.count(tag) == 1);
  }
  for (const auto& [tag, file] : cited) {
    INFO(file << " cites [" << tag << "]");
    CHECK(entries.count(tag) == 1);
  }
}
