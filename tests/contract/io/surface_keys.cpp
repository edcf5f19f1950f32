// What a body says of its surface file: unit, axes, scale, part, hull, mending, copies. Masses by formula.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "engine/geometry/mass_properties.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/refusal.hpp"
#include "viewer/controller/session.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

TriangleMesh brick() { return box({0.5, 1.0, 1.5}, {1, 1, 1}); }

TriangleMesh with(TriangleMesh mesh, const TriangleMesh& other, const Vec3& shift) {
  append(mesh, other, shift);
  return mesh;
}

std::string body_text(const std::string& keys) {
  return "[[body]]\nname = \"b\"\nkind = \"dynamic\"\nsurface = \"b.off\"\n" + keys;
}

/// A scene of that body, loaded.
struct Loaded {
  TempFolder folder;
  std::unique_ptr<Session> session;

  Loaded(const TriangleMesh& mesh, const std::string& keys, const std::vector<std::string>& overrides = {}) {
    folder.write("b.off", off_text(mesh));
    reload(body_text(keys), overrides);
  }
  void reload(const std::string& scene, const std::vector<std::string>& overrides = {}) {
    session = std::make_unique<Session>(folder.write("s.toml", scene), overrides, std::filesystem::path());
  }
  const Body& body(int i) const { return session->world().bodies()[BodyIndex(i)]; }
};

double mass(const TriangleMesh& mesh, const std::string& keys) { return Loaded(mesh, keys).body(0).mass; }

const std::vector<std::string> kRun = {"run", "s.toml", "--out", "out", "--frames", "1", "--no-images"};

void refused(const TriangleMesh& mesh, const std::string& keys, const std::string& place, const std::string& contains) {
  const TempFolder folder;
  folder.write("b.off", off_text(mesh));
  folder.write("s.toml", body_text(keys));
  check_refused(folder, kRun, "s.toml:" + place + ": ", contains);
}

}  // namespace

TEST_CASE("unit, up and scale place a surface, by its mass and its box") {
  CHECK(mass(brick(), "") == Approx(6000.0));
  CHECK(mass(brick(), "unit = \"cm\"\n") == Approx(6e-3));
  CHECK(mass(brick(), "unit = \"inch\"\n") == Approx(6000.0 * std::pow(0.0254, 3)));
  CHECK(mass(brick(), "unit = \"mm\"\nscale = 1000\n") == Approx(6000.0));
  CHECK(mass(brick(), "scale = [2, 3, 4]\n") == Approx(6000.0 * 24.0));
  const Loaded turned(brick(), "up = \"z\"\nscale = [1, 2, 1]\n");
  const Aabb box = turned.body(0).shape->bounds({});
  CHECK(box.extent().isApprox(Vec3(1.0, 6.0, 2.0)));
  CHECK(turned.body(0).mass == Approx(12000.0));

  refused(brick(), "unit = \"ell\"\n", "5:8", "mm, cm");
  refused(brick(), "up = \"x\"\n", "5:6", "is allowed");
  refused(brick(), "scale = [1, 0, 1]\n", "5:9", "greater than 0");
  const TempFolder folder;
  folder.write("s.toml",
               "[[body]]\nname = \"b\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 1 } }\nunit = \"mm\"\n");
  check_refused(folder, kRun, "s.toml:5:1: ", "belongs to a surface file");
  folder.write("s.toml",
               "[[body]]\nname = \"b\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 1 } }\nscale = [1, 2, 3]\n");
  check_refused(folder, kRun, "s.toml:5:9: ", "one number is wanted");
}

TEST_CASE("one part of several, and a hull, can be the body") {
  const TriangleMesh two = with(brick(), box(Vec3::Constant(0.5)), {5.0, 0.0, 0.0});
  CHECK(mass(two, "") == Approx(7000.0));
  CHECK(mass(two, "component = 2\n") == Approx(1000.0));
  refused(two, "component = 3\n", "5:13", "has 2 connected parts");
  const Loaded hull(torus(1.0, 0.3, 40, 20), "convex = true\n");
  CHECK(hull.body(0).shape->name() == "convex_hull");
  // a disk swept by a ball: 2 r pi R^2 + pi^2 R r^2 + 4/3 pi r^3; its corners lie on that surface
  CHECK(hull.body(0).mass == Approx(1000.0 * M_PI * (0.6 + M_PI * 0.09 + 4.0 / 3.0 * 0.027)).epsilon(0.02));
  TriangleMesh open = brick();
  open.triangles.pop_back();
  CHECK(mass(open, "convex = true\n") == Approx(6000.0));
  refused(sheet(1.0, 4), "convex = true\n", "4:11", "in one plane");
}

TEST_CASE("what bounds no solid is refused with the way to mend it, and mended by it") {
  TriangleMesh open = box(Vec3::Constant(0.5), {4, 4, 4});
  open.triangles.pop_back();
  const TriangleMesh sound = box(Vec3::Constant(0.5));
  TriangleMesh twice = sound;
  twice.triangles.push_back({0, 0, 1});
  TriangleMesh mixed = sound;
  std::swap(mixed.triangles[3][0], mixed.triangles[3][1]);
  // wrong by twice its volume, and silent, where only the sum is looked at
  const TriangleMesh second = with(sound, inside_out(box(Vec3::Constant(0.25))), {3.0, 0.0, 0.0});
  struct Case {
    TriangleMesh mesh;
    const char* problem;
    double kilograms;
  };
  for (const Case& c : {Case{open, "is not closed", 1000.0}, Case{twice, "degenerate", 1000.0},
                        Case{mixed, "is not oriented", 1000.0}, Case{second, "component 2 of 2 inside out", 1125.0}}) {
    refused(c.mesh, "", "4:11", c.problem);
    refused(c.mesh, "", "4:11", "mend = true");
    CHECK(mass(c.mesh, "mend = true\n") == Approx(c.kilograms));
    refused(c.mesh, "mend = false\n", "4:11", c.problem);
  }
  refused(open, "", "4:11", "b.off --mend --out NEW.ply");
  CHECK(mass(sheet(1.0, 4), "mend = { thickness = 0.01 }\n") == Approx(40.0));
  CHECK(mass(with(sound, box(Vec3::Constant(0.5)), {0.5, 0.0, 0.0}), "mend = true\n") == Approx(2000.0));
  CHECK(mass(with(sound, box(Vec3::Constant(0.5)), {0.5, 0.0, 0.0}), "mend = { remesh = 60 }\n") ==
        Approx(1500.0).epsilon(0.02));
  refused(open, "mend = 3\n", "5:8", "true, false or a table");
  refused(open, "mend = { wield = 3 }\n", "5:10", "did you mean 'weld'?");
  refused(open, "mend = { remesh = 3 }\n", "5:19", "mend.remesh");

  const Loaded loaded(open, "mend = true\n");
  const Outcome info = impinge_run(loaded.folder.path(), {"info", "s.toml"});
  CHECK(info.code == 0);
  CHECK(info.out.find("mended: filled 1 hole with 1 triangle") != std::string::npos);
}

TEST_CASE("a mended surface runs, and its run repeats itself") {
  TriangleMesh open = box(Vec3::Constant(0.5), {4, 4, 4});
  open.triangles.pop_back();
  const TempFolder folder;
  folder.write("b.off", off_text(open));
  folder.write("s.toml",
               "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], offset "
               "= -0.6 } }\n" +
                   body_text("mend = true\nunit = \"m\"\ncopies = [ { position = [2, 0, 0] } ]\n"));
  CHECK(impinge_run(folder.path(), {"run", "s.toml", "--frames", "20", "--no-images", "--out", "out"}).code == 0);
  CHECK(impinge_run(folder.path(), {"replay", "out"}).code == 0);
}

TEST_CASE("copies are bodies like those written out, to the bit") {
  const std::string placed = "position = [0, 3, 0]\nvelocity = [1, 0, 0]\n";
  const Loaded copies(brick(), placed +
                                   "copies = [ { position = [4, 3, 0] }, { name = \"last\", position = [8, "
                                   "3, 0], velocity = [0, 0, 2], rotation = [0, 0, 30] } ]\n");
  Loaded written(brick(), placed);
  written.reload(
      body_text(placed) + replaced(replaced(body_text(placed), "[0, 3, 0]", "[4, 3, 0]"), "\"b\"", "\"b_2\"") +
      replaced(body_text("position = [8, 3, 0]\nvelocity = [0, 0, 2]\nrotation = [0, 0, 30]\n"), "\"b\"", "\"last\""));
  for (int i = 0; i < 10; ++i) copies.session->advance(), written.session->advance();
  REQUIRE(copies.session->record().bodies.size() == 3);
  CHECK(copies.session->record().stats.state_hash == written.session->record().stats.state_hash);
  CHECK(copies.body(1).name == "b_2");
  CHECK(copies.body(2).name == "last");
  CHECK(copies.body(0).shape.get() == copies.body(1).shape.get());

  const Loaded grid(brick(), "position = [1, 0, 0]\ncopies = { count = [2, 1, 3], spacing = [2, 9, 4] }\n",
                    {"body.b_6.mass=5"});
  REQUIRE(grid.session->world().bodies().size() == 6);
  CHECK(grid.body(5).mass == 5.0);
  CHECK(grid.body(5).pose.position.isApprox(Vec3(3.0, 0.0, 8.0)));
  CHECK(grid.body(1).pose.position.isApprox(Vec3(3.0, 0.0, 0.0)));

  refused(brick(), "copies = 3\n", "5:10", "a list of placements");
  refused(brick(), "copies = [ { rotation = [0, 0, 0] } ]\n", "5:12", "has no position");
  refused(brick(), "copies = [ { position = [0, 0, 0], name = \"b\" } ]\n", "5:43", "a second body named 'b'");
  refused(brick(), "copies = { count = [1e3, 1e3, 1e3], spacing = [1, 1, 1] }\n", "5:20", "bodies at most");
}

TEST_CASE("a cage by winding numbers takes an open surface and weighs what the closed one does") {
  TriangleMesh torn = icosphere(4, 0.5);
  const auto deformable = [](const std::string& cage) {
    return "volume = { cage = { " + cage + " } }\nmaterial = { young = 1e5, poisson = 0.3, density = 1000 }\n";
  };
  const auto soft = [&](const TriangleMesh& mesh, const std::string& cage) {
    const TempFolder folder;
    folder.write("b.off", off_text(mesh));
    folder.write("s.toml", replaced(body_text(deformable(cage)), "dynamic", "deformable"));
    Session session(folder / "s.toml", {}, {});
    for (int i = 0; i < 3; ++i) session.advance();
    return session.record().bodies[0].mass;
  };
  const double whole = 1000.0 * signed_volume(torn);
  CHECK(soft(torn, "cells = 24") == Approx(whole).epsilon(1e-3));
  CHECK(soft(torn, "cells = 10, inside = \"winding\"") == Approx(whole).epsilon(0.02));
  std::erase_if(torn.triangles, [](const Triangle& t) { return t[0] % 40 == 0; });
  CHECK(soft(torn, "cells = 10, inside = \"winding\"") == Approx(whole).epsilon(0.03));
  const TempFolder folder;
  folder.write("b.off", off_text(torn));
  folder.write("s.toml", replaced(body_text(deformable("cells = 10")), "dynamic", "deformable"));
  check_refused(folder, kRun, "s.toml:4:11: ", "is not closed");
  folder.write("s.toml", replaced(body_text(deformable("cells = 10, inside = \"guess\"")), "dynamic", "deformable"));
  check_refused(folder, kRun, "s.toml:5:42: ", "\"rays\" or \"winding\"");
}

TEST_CASE("a decimated body collides with few triangles, weighs and shows all of them") {
  const TriangleMesh fine = bumpy_torus(48, 24);
  const Loaded loaded(fine, "decimate = 300\nscale = 0.5\n");
  const SurfaceMesh& few = *loaded.body(0).shape->mesh();
  CHECK(few.mesh.triangles.size() <= 300);
  CHECK(few.mesh.triangles.size() > 290);
  CHECK(few.topology.is_closed());
  CHECK(few.shown().mesh.triangles == fine.triangles);
  const Loaded full(fine, "scale = 0.5\n");
  CHECK(loaded.body(0).mass == Approx(full.body(0).mass).epsilon(1e-12));
  CHECK(loaded.body(0).center.isApprox(full.body(0).center, 1e-12));
  // what is shown stands where the whole surface stands
  const std::vector<Vec3>& all = full.body(0).shape->mesh()->mesh.vertices;
  for (std::size_t v = 0; v < all.size(); ++v) CHECK((few.shown().mesh.vertices[v] - all[v]).norm() < 1e-12);
  const Outcome info = impinge_run(loaded.folder.path(), {"info", "s.toml"});
  CHECK(info.out.find("for contact: ") != std::string::npos);
  CHECK(info.out.find("of 2304 triangles, up to ") != std::string::npos);
  // as many as there are, or more: the surface itself
  const Loaded same(fine, "decimate = 2304\n");
  CHECK(same.body(0).shape->mesh()->full == nullptr);
  CHECK(same.body(0).shape->mesh()->mesh.triangles == fine.triangles);

  refused(fine, "decimate = 3\n", "5:12", "decimate");
  refused(fine, "decimate = 30.5\n", "5:12", "a whole number");
  refused(fine, "decimate = 4\n", "5:12", "or a handle; use ");
  refused(fine, "decimate = 100\nconvex = true\n", "5:1", "one of them is wanted");
  refused(fine, "decimat = 100\n", "5:1", "did you mean 'decimate'?");
  TriangleMesh open = fine;
  open.triangles.pop_back();
  refused(open, "decimate = 300\n", "4:11", "3 border edges");
  CHECK(mass(open, "decimate = 300\nmend = true\n") == Approx(8.0 * full.body(0).mass).epsilon(1e-3));
  const TempFolder folder;
  folder.write("b.off", off_text(fine));
  folder.write("s.toml",
               "[[body]]\nname = \"b\"\nkind = \"deformable\"\nsurface = \"b.off\"\ndecimate = 100\n"
               "volume = { cage = { cells = 4 } }\n");
  check_refused(folder, kRun, "s.toml:5:1: ", "impinge mesh FILE --decimate N");
}

TEST_CASE("a decimated sheet of a static body is thin and shown whole") {
  TriangleMesh hills = sheet(2.0, 40);
  for (Vec3& x : hills.vertices) x.y() = 0.2 * std::sin(2.0 * x.x()) * std::cos(1.5 * x.z());
  const TempFolder folder;
  folder.write("b.off", off_text(hills));
  const std::string text = "[[body]]\nname = \"b\"\nkind = \"static\"\nsurface = \"b.off\"\nthickness = 0.01\n";
  const auto mesh_of = [&](const std::string& keys) {
    Session session(folder.write("s.toml", text + keys), {}, std::filesystem::path());
    return session.world().bodies()[BodyIndex(0)].shape;
  };
  const SharedShape whole = mesh_of(""), few = mesh_of("decimate = 200\n");
  CHECK(few->mesh()->topology.is_closed());
  CHECK(few->mesh()->mesh.triangles.size() < 600);  // both sides of 200, and the rim
  CHECK(few->mesh()->shown().mesh.triangles == whole->mesh()->mesh.triangles);
}

TEST_CASE("decimated bodies fall, rest and repeat themselves, pictures and files show the whole surface") {
  const TempFolder folder;
  folder.write("b.off", off_text(bumpy_sphere(4)));
  const auto scene = [&](const std::string& name, const std::string& keys) {
    folder.write(name,
                 "[view]\nlayers = [\"meshes\"]\npanel.figures = false\npanel.legend = false\n"
                 "camera.eye = [3, 2, 6]\ncamera.target = [0, 0, 0]\n"
                 "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], "
                 "offset = -1.3 } }\n" +
                     body_text(keys));
    return impinge_run(folder.path(), {"run", name, "--frames", "40", "--size", "320x240", "--out", name + ".out",
                                       "--export", "vtu", "--judge"});
  };
  const Outcome few = scene("few.toml", "decimate = 250\n"), all = scene("all.toml", "");
  INFO(few.err << few.out);
  REQUIRE(few.code == 0);
  REQUIRE(all.code == 0);
  CHECK((read_png(folder / "few.toml.out/frames/000000.png") == read_png(folder / "all.toml.out/frames/000000.png")));
  CHECK(impinge_run(folder.path(), {"replay", "few.toml.out"}).code == 0);
  // it lies on the floor where the whole one does, but for the surfaces' distance
  Session coarse(folder / "few.toml", {}, std::filesystem::path()),
      fine(folder / "all.toml", {}, std::filesystem::path());
  for (int frame = 0; frame < 40; ++frame) coarse.advance(), fine.advance();
  const Body &l = coarse.world().bodies()[BodyIndex(1)], &r = fine.world().bodies()[BodyIndex(1)];
  CHECK((l.pose.position - r.pose.position).norm() < 0.1);
  CHECK(coarse.record().stats.contacts > 0);
}
