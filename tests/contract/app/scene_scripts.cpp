// The scenes that come with the program do what their scripts expect of them.
#include <catch2/catch.hpp>

#include <fstream>

#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

/// The last frame that an `expect` line speaks of.
int last_expectation(const fs::path& script) {
  std::ifstream file(script);
  int last = -1;
  for (std::string line; std::getline(file, line);)
    if (const std::size_t at = line.rfind(" at "); line.starts_with("expect ") && at != std::string::npos)
      last = std::max(last, std::stoi(line.substr(at + 4)));
  return last;
}

}  // namespace

TEST_CASE("every scene's script finds what it expects", "[long]") {
  int scenes = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(IMPINGE_SOURCE_DIR) / "scenes")) {
    const fs::path scene = entry.path(), script = fs::path(scene).replace_extension(".script");
    if (scene.extension() != ".toml" || !fs::exists(script)) continue;
    const int last = last_expectation(script);
    CAPTURE(scene.string(), last);
    CHECK(last > 0);
    const TempFolder folder;
    const Outcome outcome =
        impinge_run(folder.path(), {"run", scene.string(), "--script", script.string(), "--out", "out", "--frames",
                                    std::to_string(last), "--no-images", "--quiet"});
    INFO(outcome.err);
    CHECK(outcome.code == 0);
    ++scenes;
  }
  CHECK(scenes >= 6);
}
