#include "engine/io/tets/volume_cache.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>

#include "engine/geometry/tets/tet_cage.hpp"
#include "engine/shapes/primitives.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

CarriedVolume cage(const TriangleMesh& surface, int cells) {
  TetCageSettings settings;
  settings.cells = cells;
  TetCage made = make_tet_cage(surface, settings);
  return {std::move(made.mesh), std::move(made.fraction), std::move(made.embedding)};
}

bool same(const CarriedVolume& a, const CarriedVolume& b) {
  return a.mesh.vertices == b.mesh.vertices && a.mesh.tets == b.mesh.tets && a.fraction == b.fraction &&
         a.embedding.tet == b.embedding.tet && a.embedding.weight == b.embedding.weight &&
         a.embedding.outside == b.embedding.outside && a.embedding.farthest == b.embedding.farthest;
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::exists(folder))
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

/// An environment variable for the life of a test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old, had_ = true;
    if (value != nullptr)
      setenv(name, value, 1);
    else
      unsetenv(name);
  }
  ~Variable() {
    if (had_)
      setenv(name_, old_.c_str(), 1);
    else
      unsetenv(name_);
  }

 private:
  const char* name_;
  std::string old_;
  bool had_ = false;
};

}  // namespace

TEST_CASE("a volume is made once, then found in memory and on disk, bit for bit") {
  const TempFolder folder;
  const TriangleMesh surface = sphere_surface(0.1, 2);
  const CarriedVolume truth = cage(surface, 5);
  const auto make = [&] { return cage(surface, 5); };
  VolumeCache first(folder / "cache");
  const VolumePointer one = first.get(surface, "cage 5", make);
  CHECK(same(*one, truth));
  CHECK(first.get(surface, "cage 5", make) == one);
  CHECK(first.made() == 1);
  CHECK(files_in(folder / "cache").size() == 1);

  VolumeCache second(folder / "cache");
  const VolumePointer again =
      second.get(surface, "cage 5", [&]() -> CarriedVolume { throw std::runtime_error("made twice"); });
  CHECK(second.made() == 0);
  CHECK(same(*again, truth));
}

TEST_CASE("whatever a volume depends on is in its key") {
  VolumeCache cache{fs::path()};
  const TriangleMesh surface = sphere_surface(0.1, 1);
  const auto make = [&] { return cage(surface, 3); };
  cache.get(surface, "cage 3", make);
  cache.get(surface, "cage 4", make);
  TriangleMesh other = surface;
  other.vertices[7].z() = std::nextafter(other.vertices[7].z(), 1.0);
  cache.get(other, "cage 3", make);
  other = surface;
  std::rotate(other.triangles[0].begin(), other.triangles[0].begin() + 1, other.triangles[0].end());
  cache.get(other, "cage 3", make);
  CHECK(cache.made() == 4);
  cache.get(surface, "cage 3", make);
  CHECK(cache.made() == 4);
}

TEST_CASE("damaged files are made again without a word, and are whole afterwards") {
  const TempFolder folder;
  const TriangleMesh surface = sphere_surface(0.1, 1);
  const CarriedVolume truth = cage(surface, 3);
  const auto make = [&] { return truth; };
  VolumeCache(folder.path()).get(surface, "cage 3", make);
  REQUIRE(files_in(folder.path()).size() == 1);
  const fs::path file = files_in(folder.path())[0];
  const std::string whole = slurp(file);
  std::vector<std::string> damaged = {
      "", "x", whole.substr(0, 20), whole.substr(0, whole.size() - 1), whole + "x", std::string(whole.size(), '\0')};
  for (const std::size_t at : {std::size_t{3}, std::size_t{30}, std::size_t{55}, whole.size() / 2, whole.size() - 1}) {
    damaged.push_back(whole);
    damaged.back()[at] ^= 1;
  }
  for (const std::string& bytes : damaged) {
    folder.write(file.filename().string(), bytes);
    VolumeCache cache(folder.path());
    CHECK(same(*cache.get(surface, "cage 3", make), truth));
    CHECK(cache.made() == 1);
    CHECK(slurp(file) == whole);
  }
  CHECK(files_in(folder.path()).size() == 1);  // no temporary file is left
}

TEST_CASE("a folder that can't be made or written is no error") {
  const TempFolder folder;
  folder.write("file", "not a folder");
  const TriangleMesh surface = sphere_surface(0.1, 1);
  for (const fs::path& place : {folder / "file", folder / "file/below", fs::path("/proc/impinge"), fs::path()}) {
    VolumeCache cache(place);
    CHECK_NOTHROW(cache.get(surface, "cage 3", [&] { return cage(surface, 3); }));
    CHECK(cache.made() == 1);
  }
  CHECK(slurp(folder / "file") == "not a folder");
}

TEST_CASE("the cache's folder follows the environment") {
  const Variable home("HOME", "/home/someone");
  {
    const Variable own("IMPINGE_CACHE", "/tmp/here"), xdg("XDG_CACHE_HOME", "/var/x");
    CHECK(cache_folder() == "/tmp/here");
  }
  {
    const Variable own("IMPINGE_CACHE", "off"), xdg("XDG_CACHE_HOME", "/var/x");
    CHECK(cache_folder().empty());
  }
  const Variable own("IMPINGE_CACHE", nullptr);
  {
    const Variable xdg("XDG_CACHE_HOME", "/var/x");
    CHECK(cache_folder() == "/var/x/impinge");
  }
  {
    const Variable xdg("XDG_CACHE_HOME", "relative");
    CHECK(cache_folder() == "/home/someone/.cache/impinge");
  }
  const Variable xdg("XDG_CACHE_HOME", nullptr), none("HOME", nullptr);
  CHECK(cache_folder().empty());
}
