// The architecture as a test: includes go down only, the model knows no view, each registered file is on its folder's
// list.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace {

const fs::path kRoot = IMPINGE_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  std::stringstream all;
  all << in.rdbuf();
  return all.str();
}

std::vector<fs::path> sources() {
  std::vector<fs::path> files;
  for (const char* top : {"engine", "viewer"})
    for (const auto& e : fs::recursive_directory_iterator(kRoot / top))
      if (e.path().extension() == ".cpp" || e.path().extension() == ".hpp") files.push_back(e.path());
  return files;
}

/// The floor of a folder, which is one room whatever folders lie in it; rooms of one floor don't include each other.
const std::map<std::string, int>& floors() {
  static const std::map<std::string, int> map = {{"engine/core", 0},
                                                 {"engine/io", 1},
                                                 {"engine/algebra", 1},
                                                 {"engine/geometry", 2},
                                                 {"engine/io/meshes", 3},
                                                 {"engine/io/tets", 3},
                                                 {"engine/shapes", 3},
                                                 {"engine/materials", 3},
                                                 {"engine/bodies", 4},
                                                 {"engine/integrators", 5},
                                                 {"engine/detection", 5},
                                                 {"engine/detection/broadphase", 6},
                                                 {"engine/detection/triangles", 6},
                                                 {"engine/detection/contacts", 7},
                                                 {"engine/detection/pairs", 8},
                                                 {"engine/contact", 9},
                                                 {"engine/lcp", 10},
                                                 {"engine/response/operators", 11},
                                                 {"engine/response", 12},
                                                 {"engine/frozen", 13},
                                                 {"engine/world", 14},
                                                 {"engine/io/scene", 15},
                                                 {"viewer/image", 20},
                                                 {"viewer/draw", 20},
                                                 {"viewer/gl", 21},
                                                 {"viewer/state", 21},
                                                 {"viewer/layers", 22},
                                                 {"viewer/panels/overlay", 23},
                                                 {"viewer/panels/debug", 23},
                                                 {"viewer/present", 24},
                                                 {"viewer/controller", 25},
                                                 {"viewer/debugger", 26},
                                                 {"viewer/study", 26},
                                                 {"viewer/sweep", 26},
                                                 {"viewer/report", 27},
                                                 {"viewer/compare", 28},
                                                 {"viewer/app", 29}};
  return map;
}

std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

}  // namespace

TEST_CASE("an include goes down only") {
  REQUIRE(sources().size() > 50);
  for (const fs::path& file : sources()) {
    const std::string own = fs::relative(file, kRoot).generic_string();
    REQUIRE(floors().count(folder_of(own)) == 1);
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      const auto start = line.find("#include \"");
      if (start == std::string::npos) continue;
      const std::string target = line.substr(start + 10, line.rfind('"') - start - 10);
      CAPTURE(own, target);
      REQUIRE(fs::exists(kRoot / target));
      if (folder_of(target) == folder_of(own)) continue;
      REQUIRE(floors().count(folder_of(target)) == 1);
      CHECK(floors().at(folder_of(target)) < floors().at(folder_of(own)));
    }
  }
}

TEST_CASE("the model knows no view and no terminal") {
  for (const fs::path& file : sources()) {
    const std::string own = fs::relative(file, kRoot).generic_string();
    if (own.rfind("engine/", 0) != 0) continue;
    const std::string text = text_of(file);
    for (const char* word : {"<GL/", "imgui", "std::cout", "std::cerr", "printf(", "exit(", "<iostream>"}) {
      // ends its child process with _exit
      if (std::string(word) == "exit(" && own == "engine/io/meshes/read_with_assimp.cpp") continue;
      CAPTURE(own, word);
      CHECK(text.find(word) == std::string::npos);
    }
  }
}

TEST_CASE("every registered algorithm's file is named in its folder's list") {
  for (const char* folder : {"engine/detection/broadphase", "engine/detection/triangles", "engine/integrators",
                             "engine/lcp", "engine/response", "viewer/layers", "viewer/panels/debug", "viewer/app"}) {
    const std::string list = text_of(kRoot / folder / "all.cpp");
    int entries = 0;
    for (const auto& e : fs::directory_iterator(kRoot / folder)) {
      if (e.path().extension() != ".cpp" || e.path().filename() == "all.cpp") continue;
      const std::string text = text_of(e.path());
      const std::string stem = e.path().stem().string();
      // a file that declares an entry is named like it
      if (text.find("\nEntry<") == std::string::npos && text.find("Layer " + stem) == std::string::npos &&
          text.find("\nPanel " + stem + "_panel()") == std::string::npos)
        continue;
      CAPTURE(folder, stem);
      CHECK(list.find(stem) != std::string::npos);
      ++entries;
    }
    CAPTURE(folder);
    CHECK(entries > 0);
  }
}

TEST_CASE("a folder holds at most 40 files") {
  std::map<std::string, int> files;
  for (const fs::path& file : sources()) ++files[fs::relative(file.parent_path(), kRoot).generic_string()];
  for (const auto& [folder, count] : files) {
    CAPTURE(folder);
    CHECK(count <= 40);
    CHECK(floors().count(folder) == 1);
  }
  for (const auto& [folder, floor] : floors()) {
    CAPTURE(folder);
    CHECK(files.count(folder) == 1);
  }
}

TEST_CASE("files stay small") {
  int long_files = 0;
  for (const fs::path& file : sources()) {
    std::ifstream in(file);
    int lines = 0;
    for (std::string line; std::getline(in, line);) ++lines;
    CAPTURE(file.string());
    CHECK(lines <= 450);
    if (lines > 300) ++long_files;
  }
  CHECK(long_files <= static_cast<int>(sources().size()) / 10);
}
