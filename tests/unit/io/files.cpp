// Whole files under temporary names, and what lies at a path.
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include <set>

#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("temporary names are never given twice and are known again") {
  const TempFolder folder;
  std::set<std::string> names;
  for (int i = 0; i < 100; ++i) names.insert(temporary_name(folder / "x.csv").filename().string());
  CHECK(names.size() == 100);
  for (const std::string& name : names) {
    CAPTURE(name);
    CHECK(name.starts_with("x.csv."));
    CHECK(name.ends_with(".tmp"));
    CHECK(is_temporary_name(name));
  }
  const std::filesystem::path film = temporary_name(folder / "a.film.mp4", true);
  CHECK(film.parent_path() == folder.path());
  CHECK(film.extension() == ".mp4");
  CHECK(is_temporary_name(film.filename().string()));
  for (const char* other : {"", ".tmp", "x.tmp", "x.1.tmp", "x.1-.tmp", "x.-1.tmp", ".1-2.tmp", "x.1-2.tmp.a.b",
                            "1-2.tmp", "x.1-2.temp", "x.a-2.tmp", "000001.png", "run.toml"})
    CHECK_FALSE(is_temporary_name(other));
}

TEST_CASE("a file that several processes write at once is whole at any moment, and nothing stays beside it") {
  const TempFolder folder;
  const std::filesystem::path file = folder / "x";
  constexpr std::size_t kSize = 200'000;
  const auto text = [](int who) { return std::string(kSize, static_cast<char>('a' + who)); };
  write_file(file, text(0));
  std::vector<pid_t> all;
  for (int who = 0; who < 4; ++who) {
    const pid_t pid = fork();
    if (pid == 0) {
      try {
        for (int k = 0; k < 60; ++k) write_file(file, text(who));
      } catch (...) {
        _exit(1);
      }
      _exit(0);
    }
    all.push_back(pid);
  }
  int broken = 0;
  for (int k = 0; k < 200; ++k) {
    const std::string now = slurp(file);
    broken += now.size() != kSize || now.find_first_not_of(now[0]) != std::string::npos;
  }
  CHECK(broken == 0);
  for (const pid_t pid : all) {
    int status = 0;
    waitpid(pid, &status, 0);
    CHECK(status == 0);  // none found its own file taken away
  }
  CHECK(names_in(folder.path()) == std::vector<std::string>{"x"});
}

TEST_CASE("what lies at a path is told apart from what can't be known") {
  const TempFolder folder;
  folder.write("file", "x");
  folder.write("sub/file", "x");
  std::filesystem::create_symlink("loop", folder / "loop");
  std::filesystem::create_symlink("file", folder / "link");
  std::filesystem::create_symlink("nowhere", folder / "dangling");
  CHECK(path_kind(folder / "file") == PathKind::file);
  CHECK(path_kind(folder / "link") == PathKind::file);
  CHECK(path_kind(folder / "sub") == PathKind::folder);
  CHECK(path_kind(folder / "nowhere") == PathKind::nothing);
  CHECK(path_kind(folder / "dangling") == PathKind::nothing);
  CHECK(path_kind(folder / "file/below") == PathKind::nothing);
  CHECK(path_kind("/dev/null") == PathKind::other);
  for (const char* name : {"loop", "loop/below"})
    CHECK_THROWS_WITH(path_kind(folder / name), Catch::Contains("Too many levels of symbolic links"));
  CHECK_THROWS_WITH(path_kind(folder / std::string(300, 'x')), Catch::Contains("File name too long"));
  CHECK(names_in(folder / "sub") == std::vector<std::string>{"file"});
  CHECK_THROWS_WITH(names_in(folder / "gone"), Catch::Contains("No such file or directory"));
  CHECK_THROWS_WITH(make_folder(folder / "file"), Catch::Contains("can't be made ("));
  CHECK_THROWS_AS(make_folder(folder / "file/below"), OutputError);
  make_folder(folder / "a/b/c");
  make_folder(folder / "a/b/c");
  CHECK(is_folder(folder / "a/b/c"));
}
