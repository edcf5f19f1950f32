// The architecture as a test: includes go down only, the model knows no view, each registered file is on its folder's
// list.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
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

std::vector<fs::path> sources(const std::vector<std::string>& tops = {"engine", "viewer"}) {
  std::vector<fs::path> files;
  for (const std::string& top : tops)
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
                                                 {"engine/geometry/convex", 3},
                                                 {"engine/geometry/surface", 3},
                                                 {"engine/geometry/tets", 3},
                                                 {"engine/rotation", 3},
                                                 {"engine/geometry/mend", 4},
                                                 {"engine/io/meshes", 4},
                                                 {"engine/io/tets", 4},
                                                 {"engine/shapes", 4},
                                                 {"engine/materials", 4},
                                                 {"engine/elements", 5},
                                                 {"engine/bodies", 6},
                                                 {"engine/integrators", 7},
                                                 {"engine/detection", 7},
                                                 {"engine/detection/broadphase", 8},
                                                 {"engine/detection/triangles", 8},
                                                 {"engine/detection/continuous", 8},
                                                 {"engine/detection/contacts", 9},
                                                 {"engine/detection/pairs", 10},
                                                 {"engine/contact", 11},
                                                 {"engine/contact/recovery", 12},
                                                 {"engine/lcp", 12},
                                                 {"engine/response/operators", 13},
                                                 {"engine/response", 14},
                                                 {"engine/frozen", 15},
                                                 {"engine/step/turns", 15},
                                                 {"engine/step/roots", 15},
                                                 {"engine/step/cuts", 17},
                                                 {"engine/step", 16},
                                                 {"engine/ledger", 17},
                                                 {"engine/world", 18},
                                                 {"engine/io/scene", 19},
                                                 {"engine/preflight", 20},
                                                 {"viewer/image", 21},
                                                 {"viewer/draw", 21},
                                                 {"viewer/gl", 22},
                                                 {"viewer/state", 22},
                                                 {"viewer/layers", 23},
                                                 {"viewer/panels/overlay", 24},
                                                 {"viewer/panels/debug", 24},
                                                 {"viewer/preflight", 25},
                                                 {"viewer/notes", 25},
                                                 {"viewer/present", 25},
                                                 {"viewer/export", 25},
                                                 {"viewer/tables", 25},
                                                 {"viewer/web", 26},
                                                 {"viewer/vnc", 26},
                                                 {"viewer/controller", 26},
                                                 {"viewer/bundle", 27},
                                                 {"viewer/debugger", 28},
                                                 {"viewer/study", 28},
                                                 {"viewer/sweep", 28},
                                                 {"viewer/shrink", 28},
                                                 {"viewer/report", 29},
                                                 {"viewer/compare", 30},
                                                 {"viewer/app", 31}};
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
      if (std::string(word) == "exit(" && own == "engine/io/meshes/import_in_child.cpp") continue;
      CAPTURE(own, word);
      CHECK(text.find(word) == std::string::npos);
    }
  }
}

TEST_CASE("what lies at a path is asked of engine/io/paths, which tells why it can't be known") {
  // these throw, or take what may not be seen for what isn't there; with an error_code the caller has decided
  const std::regex call(
      "(fs|filesystem)::(status|exists|is_regular_file|is_directory|absolute|current_path|"
      "directory_iterator|create_directories|remove|remove_all|rename|file_size)\\([^;]*");
  for (const fs::path& file : sources()) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      std::smatch found;
      if (!std::regex_search(line, found, call) || found.str().find("error)") != std::string::npos) continue;
      if (found.str().find("directory_iterator()") != std::string::npos) continue;  // the end of one
      CAPTURE(fs::relative(file, kRoot).generic_string(), line);
      CHECK(found.str().find("ignored)") != std::string::npos);
    }
  }
}

TEST_CASE("a folder's list names every file that makes an entry, by its stem, and nothing else") {
  struct List {
    const char *folder, *file, *suffix;
  };
  for (const List& list :
       {List{"engine/algebra", "linear_solver.cpp", "_solver"},
        List{"engine/detection/broadphase", "all.cpp", "_broad_phase"},
        List{"engine/detection/triangles", "all.cpp", "_narrow_phase"},
        List{"engine/integrators", "all.cpp", "_integrator"}, List{"engine/lcp", "all.cpp", "_solver"},
        List{"engine/materials", "all.cpp", "_material"}, List{"engine/response", "all.cpp", "_response"},
        List{"engine/preflight", "all.cpp", "_warning"}, List{"viewer/layers", "all.cpp", "_layer"}}) {
    CAPTURE(list.folder);
    const auto names_in = [&](const std::string& text, const std::string& form) {
      std::set<std::string> names;
      const std::regex pattern(form);
      for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) names.insert((*it)[1]);
      return names;
    };
    const std::set<std::string> listed = names_in(text_of(kRoot / list.folder / list.file),
                                                  R"(IMPINGE_LIST\(all, (\w+))" + std::string(list.suffix) + R"(\);)");
    std::set<std::string> made;
    for (const auto& e : fs::directory_iterator(kRoot / list.folder)) {
      if (e.path().extension() != ".cpp") continue;
      const std::string stem = e.path().stem().string();
      for (const std::string& name :
           names_in(text_of(e.path()), R"(\n(?:Entry<\w+>|Layer) (\w+))" + std::string(list.suffix) + R"(\(\) \{)")) {
        CAPTURE(stem, name);
        CHECK(name == stem);
        made.insert(name);
      }
    }
    CHECK(made.size() > 1);
    CHECK(listed == made);
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
  std::map<std::string, int> tests;
  for (const fs::path& file : sources({"tests"})) ++tests[fs::relative(file.parent_path(), kRoot).generic_string()];
  CHECK(tests.size() > 20);
  for (const auto& [folder, count] : tests) {
    CAPTURE(folder);
    CHECK(count <= 40);
  }
}

TEST_CASE("a function has at most 80 lines") {
  // as .clang-format writes them: a head at the margin, or two columns in as a class has it, up to the bracket below it
  const std::regex none(R"(^\s*(namespace|class|struct|enum|union|extern|if|for|while|switch|do|try|\}).*)");
  int functions = 0;
  for (const fs::path& file : sources())
    for (const std::string margin : {"", "  "}) {
      std::istringstream in(text_of(file));
      int line_number = 0, begin = 0;
      for (std::string line; std::getline(in, line);) {
        ++line_number;
        if (line == margin + "}" || line == margin + "};") {
          CAPTURE(fs::relative(file, kRoot).generic_string(), begin);
          if (begin > 0) CHECK(line_number - begin < 80);
          functions += begin > 0;
          begin = 0;
        } else if (line.size() > margin.size() && line.starts_with(margin) && line[margin.size()] != ' ' &&
                   line.ends_with('{') && !std::regex_match(line, none)) {
          begin = line_number;
        }
      }
    }
  CHECK(functions > 1000);
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
