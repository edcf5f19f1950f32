// impinge mesh: its page, table, JSON, picture and what it writes, held against what formulas say of the surface.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <regex>

#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/mesh_facts.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/refusal.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

bool says(const Outcome& outcome, const std::string& text) { return outcome.out.find(text) != std::string::npos; }

TriangleMesh open_cube() {
  TriangleMesh mesh = box(Vec3::Constant(0.5), {4, 4, 4});
  mesh.triangles.pop_back();
  return mesh;
}

}  // namespace

TEST_CASE("mesh says what a surface is") {
  const TempFolder folder;
  folder.write("ring.off", off_text(torus(1.0, 0.25, 60, 30)));
  const Outcome page = impinge_run(folder.path(), {"mesh", "ring.off"});
  CHECK(page.code == 0);
  CHECK(page.err.empty());
  CHECK(says(page, "2.5 x 0.4973 x 2.5 m, unit not said: taken for metres"));
  CHECK(says(page, "1800 vertices, 3600 triangles, 1 part, genus 1"));
  CHECK(says(page, "faults:      none"));
  CHECK(says(page, "any kind, as it is"));
  const Outcome json = impinge_run(folder.path(), {"mesh", "ring.off", "--json"});
  CHECK(says(json, "\"genus\": 1"));
  CHECK(says(json, "\"closed\": true"));
  CHECK(says(json, "\"problem\": null"));
}

TEST_CASE("mesh asks about the unit where a length is odd") {
  const TempFolder folder;
  folder.write("big.off", off_text(box({90.0, 10.0, 10.0})));
  folder.write("small.off", off_text(box({1e-3, 1e-3, 1e-3})));
  CHECK(says(impinge_run(folder.path(), {"mesh", "big.off"}), "180 m long: is it in millimetres or centimetres?"));
  CHECK(says(impinge_run(folder.path(), {"mesh", "small.off"}), "0.002 m long: is it in kilometres or inches?"));
  const Outcome told = impinge_run(folder.path(), {"mesh", "big.off", "--unit", "mm"});
  CHECK_FALSE(says(told, "is it in"));
  CHECK(says(told, "0.18 x 0.02 x 0.02 m, unit: mm"));
  CHECK(says(told, "(-0.09, -0.01, -0.01), (0.09, 0.01, 0.01) m"));
}

TEST_CASE("mesh --mend says what it did, and what it writes is a solid") {
  const TempFolder folder;
  folder.write("open.off", off_text(open_cube()));
  const Outcome before = impinge_run(folder.path(), {"mesh", "open.off"});
  CHECK(says(before, "none, it is open"));
  CHECK(says(before, "3 border edges round 1 hole"));
  CHECK(says(before, "impinge mesh open.off --mend --out NEW.ply"));
  const Outcome mend = impinge_run(folder.path(), {"mesh", "open.off", "--mend", "--out", "new.ply"});
  CHECK(mend.code == 0);
  CHECK(says(mend, "mended:      filled 1 hole with 1 triangle"));
  CHECK(says(mend, "1 m³ after"));
  CHECK(says(mend, "moved:       no vertex"));
  CHECK(signed_volume(read_mesh(folder / "new.ply")) == Approx(1.0));
  CHECK(says(impinge_run(folder.path(), {"mesh", "new.ply", "--mend"}), "nothing to do"));
}

TEST_CASE("mesh: what overlaps counted twice is told apart from what mending did") {
  const TempFolder folder;
  // two cubes of 1 m³, one moved by 0.4 m: 0.6 m³ are in both, 1.4 m³ in one at least
  TriangleMesh both = box(Vec3::Constant(0.5), {4, 4, 4});
  const TriangleMesh one = both;
  const int count = static_cast<int>(one.vertices.size());
  for (const Vec3& p : one.vertices) both.vertices.push_back(p + Vec3(0.4, 0, 0));
  for (const Triangle& t : one.triangles) both.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  folder.write("both.off", off_text(both));
  CHECK(enclosed_volume(one).value() == Approx(1.0).epsilon(5e-3));
  CHECK(enclosed_volume(both).value() == Approx(1.4).epsilon(5e-3));
  TriangleMesh open = both;
  open.triangles.pop_back();
  CHECK_FALSE(enclosed_volume(open));
  const Outcome page = impinge_run(folder.path(), {"mesh", "both.off", "--mend", "--remesh", "80"});
  CAPTURE(page.out);
  std::smatch found;
  REQUIRE(
      std::regex_search(page.out, found,
                        std::regex("volume: +2 m³ before, ([0-9.]+) m³ of it more than once, where parts overlap; "
                                   "([0-9.]+) m³ after \\(([-+0-9.]+) % of the ([0-9.]+) m³ that they take up\\)")));
  CHECK(std::stod(found[1]) == Approx(0.6).epsilon(5e-3));
  CHECK(std::stod(found[2]) == Approx(1.4).epsilon(5e-3));
  CHECK(std::abs(std::stod(found[3])) < 0.5);
  CHECK(std::stod(found[4]) == Approx(1.4).epsilon(5e-3));
  CHECK(says(impinge_run(folder.path(), {"mesh", "both.off", "--mend", "--remesh", "80", "--json"}),
             "\"enclosed_before\": 1.4"));
  // without a new skin the overlap is still there and still counts twice
  const Outcome kept = impinge_run(folder.path(), {"mesh", "both.off", "--mend"});
  CHECK(says(kept, "volume:      2 m³ before, 2 m³ after (+0 %)"));
  CHECK(says(kept, "overlaps count twice"));
  folder.write("one.off", off_text(one));
  CHECK_FALSE(says(impinge_run(folder.path(), {"mesh", "one.off", "--mend", "--remesh", "80"}), "overlap"));
  // what isn't closed has no inside to measure: the change says what it may come from
  folder.write("open.off", off_text(open));
  CHECK(says(impinge_run(folder.path(), {"mesh", "open.off", "--mend", "--remesh", "80"}),
             "%, overlaps counted twice before)"));
}

TEST_CASE("mesh --decimate writes as many triangles as are asked for, of the same volume") {
  const TempFolder folder;
  const TriangleMesh ring = bumpy_torus(48, 24);
  folder.write("ring.off", off_text(ring));
  const Outcome page = impinge_run(folder.path(), {"mesh", "ring.off", "--decimate", "400", "--out", "few.ply"});
  CHECK(page.code == 0);
  CHECK(says(page, "decimated:   400 of 2304 triangles, up to "));
  CHECK(says(page, "volume kept"));
  CHECK(says(page, "written:     few.ply"));
  const TriangleMesh few = read_mesh(folder / "few.ply");
  CHECK(few.triangles.size() == 400);
  CHECK(signed_volume(few) == Approx(signed_volume(ring)).epsilon(1e-9));
  CHECK(says(impinge_run(folder.path(), {"mesh", "few.ply"}), "1 part, genus 1"));
  const Outcome json = impinge_run(folder.path(), {"mesh", "ring.off", "--decimate", "400", "--json"});
  CHECK(says(json, "\"decimate\": {\"triangles_before\": 2304, \"triangles_after\": 400, "));
  CHECK(impinge_run(folder.path(), {"mesh", "ring.off", "ring.off", "--decimate", "400"}).code == 0);

  folder.write("open.off", off_text(open_cube()));
  CHECK(impinge_run(folder.path(), {"mesh", "open.off", "--decimate", "100", "--out", "o.ply"}).code == 0);
  CHECK(read_mesh(folder / "o.ply").triangles.size() <= 100);
  const Outcome both = impinge_run(folder.path(), {"mesh", "open.off", "--mend", "--decimate", "12", "--out", "m.ply"});
  CHECK(both.code == 0);
  CHECK(signed_volume(read_mesh(folder / "m.ply")) == Approx(1.0));
  CHECK(read_mesh(folder / "m.ply").triangles.size() == 12);

  check_refused(folder, {"mesh", "ring.off", "--decimate", "4", "--out", "x.ply"},
                "ring.off with --decimate 4: ", "or more");
  check_refused(folder, {"mesh", "ring.off", "--decimate", "3"}, "command line: ", "--decimate");
}

TEST_CASE("several files are a table, and one that can't be read a row and exit code 2") {
  const TempFolder folder;
  folder.write("a.off", off_text(open_cube()));
  folder.write("b.off", off_text(icosphere(2)));
  Outcome table = impinge_run(folder.path(), {"mesh", "a.off", "b.off"});
  CHECK(table.code == 0);
  CHECK(std::count(table.out.begin(), table.out.end(), '\n') == 3);
  CHECK(says(table, "open"));
  CHECK(says(table, "yes"));
  folder.write("c.off", "OFF\n1 1 0\n");
  table = impinge_run(folder.path(), {"mesh", "a.off", "c.off", "b.off"});
  CHECK(table.code == 2);
  CHECK(says(table, "not read: c.off"));
  CHECK(std::count(table.out.begin(), table.out.end(), '\n') == 4);
}

TEST_CASE("mesh draws the faults in colours that the sound surface has not") {
  const TempFolder folder;
  folder.write("open.off", off_text(open_cube()));
  const auto red = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"mesh", "open.off", "--picture", "p.png", "--size", "320x240"};
    words.insert(words.end(), more.begin(), more.end());
    REQUIRE(impinge_run(folder.path(), words).code == 0);
    const Image image = read_png(folder / "p.png");
    CHECK(image.width == 320);
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.pixel(x, y);
        count += p[0] > 180 && p[1] < 100 && p[2] < 100 ? 1 : 0;
      }
    return count;
  };
  CHECK(red({}) > 20);
  CHECK(red({"--mend"}) == 0);
}

TEST_CASE("mesh refuses what it can't do") {
  const TempFolder folder;
  folder.write("a.off", off_text(open_cube()));
  const std::string line = "command line: ";
  check_refused(folder, {"mesh", "a.off", "--out", "x.ply"}, line, "add --mend");
  check_refused(folder, {"mesh", "a.off", "--weld", "1"}, line, "add --mend");
  check_refused(folder, {"mesh", "a.off", "--mend", "--out", "x.obj"}, line, ".ply");
  check_refused(folder, {"mesh", "a.off", "a.off", "--mend", "--out", "x.ply"}, line, "one file at a time");
  check_refused(folder, {"mesh", "a.off", "--unit", "ell"}, line, "mm, cm");
  check_refused(folder, {"mesh", "a.off", "--mend", "--weld", "-1"}, line, "metres from 0");
  check_refused(folder, {"mesh", "none.off"}, "none.off", "");
  folder.write("flat.off", "OFF\n3 4 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n3 0 2 1\n3 1 2 0\n3 1 2 0\n");
  check_refused(folder, {"mesh", "flat.off", "--mend", "--out", "x.ply"}, "flat.off: ", "nothing is written");
}

namespace {

/// A cube of 1 m whose walls are `wall` thick: its cavity's surface faces inwards.
TriangleMesh hollow_cube(double wall) {
  TriangleMesh mesh = box(Vec3::Constant(0.5), {6, 6, 6});
  const TriangleMesh inner = box(Vec3::Constant(0.5 - wall), {6, 6, 6});
  const int count = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (const Triangle& t : inner.triangles) mesh.triangles.push_back({t[0] + count, t[2] + count, t[1] + count});
  return mesh;
}

}  // namespace

TEST_CASE("a new skin that tears thin walls is warned of, with cells that don't") {
  const TempFolder folder;
  folder.write("hollow.off", off_text(hollow_cube(0.06)));
  const Outcome torn = impinge_run(folder.path(), {"mesh", "hollow.off", "--mend", "--remesh", "8"});
  INFO(torn.out);
  CHECK(torn.code == 0);
  CHECK(says(torn, "warning:     the skin of 8 cells is another solid: it has "));
  CHECK(says(torn, " % of the volume; "));
  CHECK(says(torn, "its thinnest wall of 0.06 m wants cells half as wide: remesh 34\n"));  // 1 / 0.03 = 33.3
  CHECK(says(impinge_run(folder.path(), {"mesh", "hollow.off", "--mend", "--remesh", "8", "--json"}),
             "\"warning\": \"the skin of 8 cells is another solid"));
  const Outcome whole = impinge_run(folder.path(), {"mesh", "hollow.off", "--mend", "--remesh", "34"});
  CHECK_FALSE(says(whole, "warning:"));
  CHECK_FALSE(says(impinge_run(folder.path(), {"mesh", "hollow.off", "--mend"}), "warning:"));
  // the same of a scene's surface
  const auto check = [&](const std::string& cells) {
    folder.write("s.toml", "[[body]]\nname = \"it\"\nkind = \"dynamic\"\nsurface = \"hollow.off\"\nmend = { remesh = " +
                               cells + " }\nmaterial = { density = 1000 }\n");
    return impinge_run(folder.path(), {"check", "s.toml"});
  };
  const Outcome warned = check("8");
  INFO(warned.out);
  CHECK(says(warned, "warning: other-skin: hollow.off: the skin of 8 cells is another solid: "));
  CHECK(says(warned, ": its thinnest wall of 0.06 m wants cells half as wide: remesh 34\n"));
  CHECK_FALSE(says(check("34"), "other-skin"));
}

TEST_CASE("what a closed surface is that is no solid is said of what is wrong with it") {
  const TempFolder folder;
  TriangleMesh cube = box(Vec3::Constant(0.5));
  TriangleMesh inverted = cube, mixed = cube;
  for (Triangle& t : inverted.triangles) std::swap(t[1], t[2]);
  std::swap(mixed.triangles[0][1], mixed.triangles[0][2]);
  folder.write("inverted.off", off_text(inverted));
  folder.write("mixed.off", off_text(mixed));
  const Outcome page = impinge_run(folder.path(), {"mesh", "inverted.off"});
  CHECK(says(page, "solid:       inside out, round 1 m³ that it has for outside; area 6 m²"));
  CHECK_FALSE(says(page, "kg"));
  CHECK(says(impinge_run(folder.path(), {"mesh", "inverted.off", "--json"}), "\"volume\": -1, \"mass\": null"));
  CHECK(says(impinge_run(folder.path(), {"mesh", "mixed.off"}), "solid:       none, it is not oriented; area 6 m²"));
  folder.write("s.toml", "[[body]]\nname = \"it\"\nkind = \"static\"\nsurface = \"mixed.off\"\n");
  const Outcome info = impinge_run(folder.path(), {"info", "s.toml"});
  INFO(info.out);
  CHECK(says(info,
             "mixed.off: the surface is not oriented: neighbouring triangles face opposite ways across 3 edges: a "
             "solid "));
  CHECK_FALSE(says(info, "0 border edges"));
}
