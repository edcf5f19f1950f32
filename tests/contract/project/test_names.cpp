// CTest hands a case's name on as an element of a list: what stands after a semicolon is lost, no case has the name that is
// left, and none ran where it says that one passed.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace fs = std::filesystem;

namespace {

std::vector<std::string> names_in(const std::string& source) {
  static const std::regex named(
      "TEST_"
      R"re(CASE\(\s*"((?:[^"\\]|\\.)*)")re");
  std::vector<std::string> names;
  for (std::sregex_iterator at(source.begin(), source.end(), named), end; at != end; ++at) names.push_back((*at)[1]);
  return names;
}

bool is_handed_on(const std::string& name) { return name.find(';') == std::string::npos; }

}  // namespace

TEST_CASE("every case has a name that CTest finds it by") {
  const std::vector<std::string> sample = names_in(
      "TEST_"
      "CASE(\n    \"a film begins; it ends\", \"[tag]\") {");
  REQUIRE(sample.size() == 1);
  CHECK_FALSE(is_handed_on(sample.front()));
  std::size_t cases = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(IMPINGE_SOURCE_DIR) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    const std::vector<std::string> names = names_in(text.str());
    cases += names.size();
    for (const std::string& name : names) {
      INFO(entry.path().string() << ": " << name);
      CHECK(is_handed_on(name));
    }
  }
  CHECK(cases > 1000);
}
