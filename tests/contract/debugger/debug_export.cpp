// Frames exported from within the debugger are those of a run, to the byte, and nothing else is changed by it.
#include <catch2/catch.hpp>
#include <map>

#include "tests/support/program/debug_session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::map<std::string, std::string> files_below(const std::filesystem::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) all[std::filesystem::relative(entry.path(), folder).string()] = slurp(entry.path());
  return all;
}

}  // namespace

TEST_CASE("the debugger exports the frames that it knows, as a run of the same lines does") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("run.script", "at 6 set contact.friction 0.9\nat 9 push ball 0 0.5 0\n");
  for (const char* format : {"gltf", "ply", "poses.csv"}) {
    CAPTURE(format);
    const Outcome run = impinge_run(folder.path(), {"run", "s.toml", "--script", "run.script", "--frames", "20",
                                                    "--no-images", "--force", "--out", "run"});
    REQUIRE(run.code == 0);
    REQUIRE(impinge_run(folder.path(), {"export", "run", "--format", format, "--out", "wanted"}).code == 0);
    const std::string lines =
        "step 5\nset contact.friction 0.9\nstep 3\npush ball 0 0.5 0\nstep 12\nback 7\nstep stage 3\n";
    folder.write("plain.script", lines);
    folder.write("a.script", lines + "export " + format + " mine\n");
    const Outcome plain = debug(folder, "s.toml", "plain.script", {"--out", "."}),
                  exported = debug(folder, "s.toml", "a.script", {"--out", ".", "--answers"});
    INFO(exported.err);
    REQUIRE(exported.code == 0);
    CHECK(end_of(exported) == end_of(plain));
    CHECK(exported.out.find("exported: ") != std::string::npos);
    CHECK(exported.out.find("(21 frames)") != std::string::npos);
    CHECK(files_below(folder.path() / "mine") == files_below(folder.path() / "wanted"));
    CHECK(!files_below(folder.path() / "mine").empty());
    std::filesystem::remove_all(folder.path() / "mine");
    std::filesystem::remove_all(folder.path() / "wanted");
  }
  folder.write("wrong.script", "export gltff\n");
  const Outcome wrong = debug(folder, "s.toml", "wrong.script");
  CHECK(wrong.code == 2);
  CHECK(wrong.err.find("wrong.script:1:8: unknown format 'gltff'; allowed: ") != std::string::npos);
  CHECK(wrong.err.find("did you mean 'gltf'?") != std::string::npos);
}
