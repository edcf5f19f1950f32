// Static and scripted bodies with open surfaces, through the program: what rests on them, and each way to get it wrong.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/refusal.hpp"
#include "viewer/controller/session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::string ground(const std::string& keys) {
  return "[[body]]\nname = \"ground\"\nkind = \"static\"\nsurface = \"ground.off\"\n" + keys;
}

std::string ball(const std::string& name, double x, double y) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nkind = \"dynamic\"\nshape = {{ sphere = {{ radius = 0.05 }} }}\nposition = [{}, {}, "
      "0.03]\n",
      name, x, y);
}

std::string crate(const std::string& name, double x) {
  return fmt::format("[[body]]\nname = \"{}\"\nkind = \"dynamic\"\nsurface = \"crate.off\"\nposition = [{}, 0.06, 0]\n",
                     name, x);
}

void write_files(const TempFolder& folder, const std::string& scene) {
  folder.write("ground.off", off_text(sheet(1.0, 8)));
  folder.write("crate.off", off_text(box(Vec3::Constant(0.05), {2, 2, 2})));
  folder.write("s.toml", scene);
}

}  // namespace

TEST_CASE("balls and crates come to rest on an open sheet, from above and, to both sides, from below") {
  for (const std::string keys : {"", "sides = \"both\"\nthickness = 0.004\n", "sides = \"front\"\n"}) {
    CAPTURE(keys);
    const TempFolder folder;
    write_files(folder, ground(keys) + ball("ball", 0.3, 0.2) + crate("crate", -0.4));
    Session session(folder / "s.toml", {}, {});
    for (int i = 0; i <= 120; ++i) session.advance();
    const double top = keys.empty() ? 0.5e-3 * mean_edge_length(sheet(1.0, 8)) : keys[9] == 'b' ? 0.002 : 0.0;
    const auto& bodies = session.record().bodies;
    CHECK(bodies[1].pose.position.y() == Approx(0.05 + top).margin(2e-6));
    CHECK(bodies[2].pose.position.y() == Approx(0.05 + top).margin(2e-6));
    CHECK(session.record().stats.kinetic < 1e-9);
  }
  const TempFolder folder;
  write_files(folder, "[simulation]\ngravity = [0, 9.81, 0]\n" + ground("") + ball("ball", 0.3, -0.2));
  Session session(folder / "s.toml", {}, {});
  for (int i = 0; i <= 120; ++i) session.advance();
  CHECK(session.record().bodies[1].pose.position.y() < -0.05);
}

TEST_CASE("parts of an open surface may face inwards, pierce and hold one another: each is met from both sides") {
  TriangleMesh mesh = sheet(1.0, 8);
  const auto add = [&](const TriangleMesh& part, const Vec3& shift, bool inwards) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Vec3& v : part.vertices) mesh.vertices.push_back(v + shift);
    for (Triangle t : part.triangles) {
      if (inwards) std::swap(t[1], t[2]);
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  };
  // a block that stands in the ground and faces inwards, and one within it
  add(box(Vec3::Constant(0.2), {4, 4, 4}), {0.3, 0.1, 0.0}, true);
  add(box(Vec3::Constant(0.1), {2, 2, 2}), {0.3, 0.1, 0.0}, false);
  add(box(Vec3::Constant(0.2), {4, 4, 4}), {-0.4, 0.1, 0.0}, false);
  const TempFolder folder;
  write_files(folder, ground("thickness = 0.004\n") + ball("inwards", 0.33, 0.36) + ball("outwards", -0.43, 0.36));
  folder.write("ground.off", off_text(mesh));
  Session session(folder / "s.toml", {}, {});
  for (int i = 0; i <= 120; ++i) session.advance();
  for (const int body : {1, 2})
    CHECK(session.record().bodies[static_cast<std::size_t>(body)].pose.position.y() == Approx(0.352).margin(1e-5));
}

TEST_CASE("info says that a surface is open and how thick it is taken") {
  const TempFolder folder;
  write_files(folder, ground("thickness = 0.01\n") + ball("ball", 0.3, 0.2));
  const Outcome info = impinge_run(folder.path(), {"info", "s.toml"});
  CHECK(info.code == 0);
  CHECK(info.out.find("ground.off: the surface is open (32 border edges): a solid 0.01 m thick, met from both sides") !=
        std::string::npos);
}

TEST_CASE("sides and thickness where they have no meaning, or open surfaces where none can be, are refused") {
  const TempFolder folder;
  const std::vector<std::string> run = {"run", "s.toml", "--out", "out", "--frames", "1", "--no-images"};
  write_files(folder, replaced(ground(""), "static", "dynamic"));
  check_refused(folder, run, "s.toml:4:11: ", "is not closed");
  check_refused(folder, run, "s.toml:4:11: ", "a static or scripted body takes it as it is");
  write_files(folder, replaced(ground("sides = \"both\"\n"), "static", "dynamic"));
  check_refused(folder, run, "s.toml:5:1: ", "body.ground.sides belongs to the open surface");
  write_files(folder, replaced(ground("thickness = 0.1\n"), "ground.off", "crate.off"));
  check_refused(folder, run, "s.toml:4:11: ", "is closed");
  write_files(folder, ground("sides = \"back\"\n"));
  check_refused(folder, run, "s.toml:5:9: ", "both or front is allowed");
  write_files(folder, ground("thickness = 0\n"));
  check_refused(folder, run, "s.toml:5:13: ", "body.ground.thickness");
  TriangleMesh mixed = sheet(1.0, 8);
  std::swap(mixed.triangles[5][0], mixed.triangles[5][1]);
  write_files(folder, ground("sides = \"front\"\n"));
  folder.write("ground.off", off_text(mixed));
  check_refused(folder, run, "s.toml:4:11: ", "has no front");
}
