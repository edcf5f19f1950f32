// Volumes made from surfaces: kept between runs bit for bit, shared in a scene, and tetrahedra from a program of its
// own.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <optional>

#include "engine/bodies/deformable_body.hpp"
#include "engine/core/archive.hpp"
#include "engine/io/tets/tetrahedralize.hpp"
#include "engine/io/tets/volume_cache.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/tet_writers.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/program/refusal.hpp"
#include "viewer/controller/session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

/// A variable of the environment, which the program inherits, for the life of a test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { old_ ? setenv(name_, old_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

const std::string kBall =
    "[[body]]\nname = \"ball\"\nkind = \"deformable\"\nsurface = \"ball.off\"\nvolume = { cage = { cells = 4 } "
    "}\nposition = [0, 1, 0]\n";

struct Files {
  TempFolder folder;
  Files() {
    folder.write("scene/ball.off", off_text(bumpy_sphere(2)));
    folder.write("scene/s.toml", kBall);
  }
  fs::path scene() const { return folder / "scene/s.toml"; }
  std::string cache() const { return (folder / "cache").string(); }
  std::vector<fs::path> kept() const {
    std::vector<fs::path> files;
    if (fs::exists(folder / "cache"))
      for (const auto& entry : fs::directory_iterator(folder / "cache")) files.push_back(entry.path());
    return files;
  }
};

// all that a volume gives a body, as bits
std::string bits(const fs::path& scene) {
  Session session(scene, {}, {});
  std::string out;
  for (const Body& body : session.world().bodies()) {
    const auto* own = body.as<DeformableBody>();
    ByteWriter bytes;
    for (const Vec3& x : own->fem.rest().vertices) bytes.put(x);
    for (const Tet& tet : own->fem.rest().tets)
      for (const int i : tet) bytes.put(i);
    for (const double m : own->fem.node_mass()) bytes.put(m);
    for (const Vec4& w : own->embedding.weight)
      for (int k = 0; k < 4; ++k) bytes.put(w[k]);
    out += bytes.bytes();
  }
  for (int i = 0; i < 3; ++i) session.advance();
  return out + hex64(session.record().stats.state_hash);
}

}  // namespace

TEST_CASE("a cage from the cache is the cage that was made, bit for bit") {
  const Files files;
  std::string made;
  {
    const Variable off("IMPINGE_CACHE", "off");
    made = bits(files.scene());
    CHECK(cache_folder().empty());
  }
  const Variable cache("IMPINGE_CACHE", files.cache());
  CHECK(files.kept().empty());
  CHECK(bits(files.scene()) == made);
  REQUIRE(files.kept().size() == 1);
  const fs::path file = files.kept()[0];
  const std::string bytes = slurp(file);

  // the second time it is read: what the file holds is what arrives
  const auto written = fs::last_write_time(file);
  CHECK(bits(files.scene()) == made);
  CHECK(fs::last_write_time(file) == written);
  CHECK(files.kept().size() == 1);

  // whatever happened to the file, the body is the same and the file good again
  std::string flipped = bytes;
  flipped[bytes.size() / 2] ^= 1;
  std::string old = bytes;
  old[0] ^= 1;
  for (const std::string& damaged :
       {flipped, old, bytes.substr(0, bytes.size() / 2), bytes + "x", std::string(), std::string(1000, 'x')}) {
    std::ofstream(file, std::ios::binary) << damaged;
    CHECK(bits(files.scene()) == made);
    CHECK(slurp(file) == bytes);
  }
  CHECK(files.kept().size() == 1);
}

TEST_CASE("bodies share a cage where surface, scale and cells are the same") {
  const Files files;
  const Variable cache("IMPINGE_CACHE", files.cache());
  const auto more = [](const std::string& name, const std::string& keys) {
    return replaced(kBall, "\"ball\"", "\"" + name + "\"") + keys;
  };
  files.folder.write("scene/s.toml",
                     kBall + more("b", "material = { young = 1e6 }\n") + more("c", "rotation = [0, 90, 0]\n"));
  bits(files.scene());
  CHECK(files.kept().size() == 1);
  files.folder.write("scene/s.toml", kBall + more("b", "scale = 2\n"));
  bits(files.scene());
  CHECK(files.kept().size() == 2);
  files.folder.write("scene/s.toml", kBall + replaced(more("b", ""), "cells = 4", "cells = 5"));
  bits(files.scene());
  CHECK(files.kept().size() == 3);
}

TEST_CASE("a cache that can't be written is no reason to fail") {
  const Files files;
  files.folder.write("taken", "a file");
  for (const std::string& folder :
       {std::string("/proc/impinge"), (files.folder / "taken").string(), (files.folder / "taken/below").string()}) {
    const Variable cache("IMPINGE_CACHE", folder);
    const Outcome outcome = impinge_run(files.folder.path(), {"check", "scene/s.toml"});
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
  }
  CHECK(slurp(files.folder / "taken") == "a file");
}

TEST_CASE("the cache's folder is the one that the environment names") {
  const Variable own("IMPINGE_CACHE", ""), base("XDG_CACHE_HOME", ""), home("HOME", "/somewhere");
  CHECK(cache_folder() == "/somewhere/.cache/impinge");
  {
    const Variable xdg("XDG_CACHE_HOME", "/base");
    CHECK(cache_folder() == "/base/impinge");
    const Variable named("IMPINGE_CACHE", "/own");
    CHECK(cache_folder() == "/own");
  }
  const Variable none("HOME", "");
  CHECK(cache_folder().empty());
}

TEST_CASE("tetrahedra come from the program that the environment names") {
  const Files files;
  const Variable cache("IMPINGE_CACHE", files.cache());
  const TetMesh volume = make_tet_box(Vec3::Constant(0.2), 2, 2, 2);
  files.folder.write("scene/cube.off", off_text(boundary_surface(volume)));
  files.folder.write("made.msh", msh22_text(volume));
  files.folder.write("scene/s.toml", replaced(replaced(kBall, "ball.off", "cube.off"), "cage = { cells = 4 }",
                                              "tetrahedralize = { max_size = 0.1 }"));
  const auto tool = [&](const std::string& name, const std::string& lines) {
    const fs::path path = files.folder.write(name, "#!/bin/sh\n" + lines);
    fs::permissions(path, fs::perms::owner_all);
    return path.string();
  };
  const auto refused = [&](const std::string& program, const std::string& contains) {
    const Variable named("IMPINGE_TETRAHEDRALIZE", program);
    check_refused(files.folder, {"check", "scene/s.toml"}, "scene/s.toml:5:", contains);
  };
  refused((files.folder / "nothing").string(), "impinge-tetrahedralize is not there");
  refused((files.folder / "made.msh").string(), "impinge-tetrahedralize is not there");  // not a program
  refused(tool("refuses", "echo a line; echo 'has a hole' >&2\nexit 2\n"), "failed: has a hole");
  refused(tool("silent", "exit 3\n"), "failed");
  refused(tool("killed", "kill -9 $$\n"), "signal 9");
  refused(tool("lazy", "exit 0\n"), "volume.msh");
  refused(tool("wrong", "echo nonsense > \"$2\"\n"), "volume.msh:1:1");
  CHECK(files.kept().empty());

  const std::string good = tool("good", "test \"$3 $4\" = '--max-size 0.1' && grep -q '^26 48 0$' \"$1\" && cp \"" +
                                            (files.folder / "made.msh").string() + "\" \"$2\"\n");
  {
    const Variable named("IMPINGE_TETRAHEDRALIZE", good);
    Session session(files.scene(), {}, {});
    const FemAssembly& fem = deformable(session.world(), 0).fem;
    CHECK(fem.rest().tets.size() == 48);
    CHECK(fem.total_mass() == Approx(1000.0 * 0.008).epsilon(1e-12));
  }
  // from then on the program isn't needed
  CHECK(files.kept().size() == 1);
  const Variable gone("IMPINGE_TETRAHEDRALIZE", "/nothing");
  CHECK(impinge_run(files.folder.path(), {"check", "scene/s.toml"}).code == 0);

  const auto refused_value = [&](const std::string& value, const std::string& contains) {
    files.folder.write("scene/s.toml", replaced(replaced(kBall, "ball.off", "cube.off"), "cage = { cells = 4 }",
                                                "tetrahedralize = " + value));
    check_refused(files.folder, {"check", "scene/s.toml"}, "scene/s.toml:5:", contains);
  };
  refused_value("0.1", "a table { ... } is wanted");
  refused_value("{}", "has no max_size");
  refused_value("{ max_size = 0 }", "greater than 0");
  refused_value("{ max_siz = 1 }", "did you mean 'max_size'?");
  refused_value("{ max_size = 1e-5 }", "make it larger");
}

TEST_CASE("the real tetrahedralizer fills a ball with good tetrahedra") {
  const fs::path built = fs::path(IMPINGE_PROGRAM).parent_path() / "impinge-tetrahedralize";
  const fs::path program = fs::exists(built) ? built : find_tetrahedralizer();
  if (program.empty()) {
    WARN("skipped: impinge-tetrahedralize is not built (scenes/meshes/tetrahedralize/CMakeLists.txt says how)");
    SUCCEED();
    return;
  }
  const Files files;
  const Variable cache("IMPINGE_CACHE", "off"), named("IMPINGE_TETRAHEDRALIZE", program.string());
  const TriangleMesh surface = icosphere(3, 0.1);
  const TetMesh mesh = tetrahedralize(surface, {.max_size = 0.03});
  CHECK(check_tet_mesh(mesh) == std::nullopt);
  CHECK(mesh.tets.size() > 200);
  CHECK(mesh.tets.size() < 20000);
  CHECK(total_volume(mesh) == Approx(4.0 / 3.0 * M_PI * 1e-3).epsilon(0.05));
  CHECK(smallest_dihedral_angle(mesh) > 8.0);
  double longest = 0.0;
  for (const Tet& tet : mesh.tets)
    for (const auto& [i, j] : kTetEdges)
      longest = std::max(longest, (mesh.vertices[tet[i]] - mesh.vertices[tet[j]]).norm());
  CHECK(longest < 1.5 * 0.03);

  // the same bits each time
  const TetMesh again = tetrahedralize(surface, {.max_size = 0.03});
  CHECK(again.tets == mesh.tets);
  CHECK(again.vertices == mesh.vertices);

  TriangleMesh open = surface;
  open.triangles.pop_back();
  CHECK_THROWS_WITH(tetrahedralize(open, {.max_size = 0.03}), Catch::Contains("is not a closed surface"));
}
