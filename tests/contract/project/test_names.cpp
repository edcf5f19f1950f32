// CTest hands a case's name on as an element of a list: what stands after a semicolon is lost, no case has the name that is
// left, and none ran where it says that one passed.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace fs = std::filesystem;

TEST_CASE("every case has a name that CTest finds it by") {
  const std::regex named("TEST_CASE\\(\\s*\"((?:[^\"\\\\]|\\\\.)*)\"");
  int cases = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(IMPINGE_SOURCE_DIR) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    const std::string all = text.str();
    for (std::sregex_iterator at(all.begin(), all.end(), named), end; at != end; ++at, ++cases) {
      INFO(entry.path().string() << ": " << (*at)[1]);
      CHECK((*at)[1].str().find(';') == std::string::npos);
    }
  }
  CHECK(cases > 1000);
}
