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

/// The floor of a folder; folders of one floor don't include each other, except what `shared` below allows.
const std::map<std::string, int>& floors() {
  static const std::map<std::string, int> map = {
      {"engine/core", 0},       {"engine/geometry", 1},    {"engine/materials", 2},   {"engine/bodies", 3},
      {"engine/broadphase", 4}, {"engine/narrowphase", 4}, {"engine/integrators", 4}, {"engine/contact", 4},
      {"engine/lcp", 5},        {"engine/response", 6},    {"engine/world", 7},       {"engine/io", 8},
      {"viewer/image", 9},      {"viewer/draw", 9},        {"viewer/gl", 10},         {"viewer/layers", 11},
      {"viewer/panels", 12},    {"viewer/present", 13},    {"viewer/controller", 14}, {"viewer/app", 15}};
  return map;
}

std::string folder_of(const std::string& path) {
  const auto first = path.find('/'), second = path.find('/', first + 1);
  return path.substr(0, second);
}

// collision.hpp is the plain data that detection hands on: narrow phases and the record speak it
const std::set<std::string> kPlainData = {"engine/contact/collision.hpp"};

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
      if (folder_of(target) == folder_of(own) || kPlainData.count(target)) continue;
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
      if (std::string(word) == "exit(" && own == "engine/io/read_with_assimp.cpp") continue;
      CAPTURE(own, word);
      CHECK(text.find(word) == std::string::npos);
    }
  }
}

TEST_CASE("every registered algorithm's file is named in its folder's list") {
  for (const char* folder : {"engine/broadphase", "engine/narrowphase", "engine/integrators", "engine/lcp",
                             "engine/response", "viewer/layers"}) {
    const std::string list = text_of(kRoot / folder / "all.cpp");
    int entries = 0;
    for (const auto& e : fs::directory_iterator(kRoot / folder)) {
      if (e.path().extension() != ".cpp" || e.path().filename() == "all.cpp") continue;
      const std::string text = text_of(e.path());
      const std::string stem = e.path().stem().string();
      // a file that declares an entry is named like it
      if (text.find("Entry<") == std::string::npos && text.find("Layer " + stem) == std::string::npos) continue;
      CAPTURE(folder, stem);
      CHECK(list.find(stem) != std::string::npos);
      ++entries;
    }
    CAPTURE(folder);
    CHECK(entries > 0);
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
