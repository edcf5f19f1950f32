// The program that tetrahedralizes is stood in for by scripts: what it does well is tested in
// contract/cli_soft_input.cpp.
#include "engine/io/tets/tetrahedralize.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>

#include "engine/core/error.hpp"
#include "engine/shapes/primitives.hpp"
#include "tests/support/geometry/tet_writers.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A folder that is all of PATH and may hold a script in the program's place.
class Path {
 public:
  Path() : old_(std::getenv("PATH")) { setenv("PATH", folder.path().c_str(), 1); }
  ~Path() { setenv("PATH", old_.c_str(), 1); }
  void script(const std::string& lines) const {
    const auto file = folder.write("impinge-tetrahedralize", "#!/bin/sh\n" + lines);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  const TempFolder folder;

 private:
  std::string old_;
};

std::string refusal(const TriangleMesh& surface) {
  try {
    tetrahedralize(surface, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "taken";
}

}  // namespace

TEST_CASE("the tetrahedralizer's answer is read and checked, it gets the surface and the settings") {
  const Path path;
  const TriangleMesh surface = box_surface(Vec3(0.5, 0.5, 0.5), Eigen::Vector3i(2, 2, 2));
  CHECK(find_tetrahedralizer().empty());
  CHECK(refusal(surface).find("build it (apt install libcgal-dev") != std::string::npos);

  const TetMesh mesh = make_tet_box(Vec3::Ones(), 2, 2, 2);
  path.folder.write("good.msh", msh22_text(mesh));
  path.script("/bin/cp \"$1\" " + (path.folder / "seen.off").string() + "\n/bin/cp " +
              (path.folder / "good.msh").string() + " \"$2\"\necho \"$3 $4 $5 $6\" > " +
              (path.folder / "words").string() + "\n");
  CHECK(find_tetrahedralizer() == path.folder / "impinge-tetrahedralize");
  const TetMesh made = tetrahedralize(surface, {.max_size = 0.25, .min_angle = 8});
  CHECK(made.tets == mesh.tets);
  CHECK(total_volume(made) == Approx(1.0));
  CHECK(slurp(path.folder / "words") == "--max-size 0.25 --min-angle 8\n");
  CHECK(slurp(path.folder / "seen.off").rfind("OFF\n26 48 0\n", 0) == 0);
}

TEST_CASE("a tetrahedralizer that fails is an error of the scene, with what it said") {
  const Path path;
  const TriangleMesh surface = sphere_surface(1.0, 1);
  path.script("echo hint\necho 'no luck today' >&2\nexit 2\n");
  CHECK(refusal(surface).find("failed: no luck today; ") != std::string::npos);
  path.script("exit 1\n");
  CHECK(refusal(surface).find("failed; ") != std::string::npos);
  path.script("kill -9 $$\n");
  CHECK(refusal(surface).find("was ended by signal 9") != std::string::npos);
  path.script("echo garbage > \"$2\"\n");
  CHECK(refusal(surface).find("volume.msh:1:1: ") != std::string::npos);
  path.script("exit 0\n");
  CHECK(refusal(surface).find("no such file") != std::string::npos);
}
