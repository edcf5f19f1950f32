// Whose a run's folder is, seen between any two steps of who writes it.
#include "viewer/controller/run_folder.hpp"

#include <catch2/catch.hpp>

#include "engine/core/error.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("a run's folder that another process has just begun is its, whatever stands in it so far") {
  const TempFolder folder;
  for (const RunStart how : {RunStart::anew, RunStart::resume, RunStart::force})
    for (const char* begun : {"snapshots", "run.toml"}) {
      const std::filesystem::path two = folder / "two";
      std::filesystem::remove_all(two);
      std::filesystem::create_directory(two);
      const auto take = [&] { RunFolder(two, RunRecord{}, "frames = 3\n", how, 0, false); };
      {
        const FolderLock theirs = FolderLock::take(two);
        folder.write(std::string("two/") + begun, "half");
        CHECK_THROWS_WITH(take(), Catch::Contains("is being written to by process"));
      }
      CHECK_THROWS_WITH(take(), !Catch::Contains("is being written to by process"));  // free, and another's
    }
}
