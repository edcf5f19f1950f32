// A run whose pictures come to show nothing that moves says so at its end, and from which one on.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>

#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/image/id_image.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const std::string kRolling = R"([[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "wheel"
kind = "dynamic"
shape = { sphere = { radius = 0.1 } }
position = [0, 0.1, 0]
velocity = [5, 0, 0]
angular_velocity = [0, 0, -50]
)";

std::vector<std::string> words(std::vector<std::string> more) {
  std::vector<std::string> all = {"run", "s.toml", "--frames", "12", "--size", "160x90", "--ids", "--out", "o"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

bool shows(const fs::path& picture, const std::string& body) {
  const IdImage ids = read_ids(picture);
  return std::any_of(ids.objects.begin(), ids.objects.end(), [&](const IdObject& o) { return o.body == body; });
}

}  // namespace

TEST_CASE("a run whose pictures come to show nothing that moves says from which on") {
  const TempFolder folder;
  folder.write("s.toml", kRolling);
  const Outcome ran = impinge_run(folder.path(), words({}));
  INFO(ran.out << ran.err);
  REQUIRE(ran.code == 0);
  int first = 0, count = 0;  // by what the pixels show
  for (int frame = 0; frame <= 12; ++frame)
    if (!shows(folder / fmt::format("o/ids/{:06}.png", frame), "wheel") && count++ == 0) first = frame;
  REQUIRE(count > 3);
  CHECK(ran.out.find(fmt::format("nothing that moves is in {} of the pictures, frame {} the first of them; set "
                                 "view.camera.fit = \"all\", or view.camera.follow = \"wheel\"",
                                 count, first)) != std::string::npos);

  fs::remove(folder / "o/done");
  for (int frame = first + 2; frame <= 12; ++frame) fs::remove(folder / fmt::format("o/snapshots/{:06}.bin", frame));
  const Outcome resumed = impinge_run(folder.path(), words({"--resume"}));
  INFO(resumed.out << resumed.err);
  CHECK(resumed.out.find(fmt::format("is in {} of the pictures, frame {} the first", count, first)) !=
        std::string::npos);

  for (const char* remedy : {"view.camera.fit=all", "view.camera.follow=wheel"}) {
    fs::remove_all(folder / "o");
    const Outcome mended = impinge_run(folder.path(), words({"--set", remedy}));
    INFO(remedy << ": " << mended.out << mended.err);
    REQUIRE(mended.code == 0);
    CHECK(mended.out.find("nothing that moves") == std::string::npos);
    CHECK(shows(folder / "o/ids/000012.png", "wheel"));
  }
}
