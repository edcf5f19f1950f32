// The same scene gives the same bits: for any thread count, on a second run, and after a snapshot.
#include <catch2/catch.hpp>
#include <set>

#include "engine/core/parallel.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/mechanics/state_hashes.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Every kind of shape, two real meshes, a scripted paddle: a pile that collides, slides, rests and sleeps.
void fill_scene(World& world) {
  static const MeshPointer bunny = [] {
    auto surface = std::make_shared<SurfaceMesh>();
    surface->mesh = read_mesh(IMPINGE_SOURCE_DIR "/scenes/meshes/bunny/bunny.off");
    surface->topology = make_topology(surface->mesh);
    return surface;
  }();
  world.parameters.lcp.tolerance = 1e-6;
  world.parameters.lcp.max_iterations = 100;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(fixed_plane("wall", Vec3(1, 0.2, 0), -0.25));
  BodyDescription paddle = dynamic_body("paddle", Box{Vec3(0.3, 0.05, 0.02)}, Vec3::Zero());
  paddle.kind = BodyKind::scripted;
  paddle.motion = {{0.0, Vec3(0, 0.06, 0.3), Vec3::Zero()}, {0.6, Vec3(0, 0.06, 0), Vec3(0, 60, 0)}};
  world.add_body(paddle);
  Random random(99);
  const SharedShape shapes[] = {bunny, Sphere{0.05}, Box{Vec3(0.06, 0.04, 0.05)}, Capsule{0.03, 0.05}};
  for (int i = 0; i < 12; ++i) {
    BodyDescription d = dynamic_body("body" + std::to_string(i), shapes[i % 4],
                                     Vec3(0.15 * random.sym(), 0.15 + 0.1 * i, 0.15 * random.sym()));
    d.rotation = 180.0 * random.vector();
    world.add_body(d);
  }
  world.start();
}

}  // namespace

TEST_CASE("a pile of meshes and shapes has the same hashes for 1, 2 and 4 threads, and on a second run") {
  std::vector<std::uint64_t> first;
  for (int threads : {1, 2, 4, 1}) {
    const Threads guard(threads);
    World world;
    fill_scene(world);
    const std::vector<std::uint64_t> list = hashes(world, 60);
    if (first.empty()) {
      first = list;
      CHECK(world.record().stats.contacts > 0);
      CHECK(std::set<std::uint64_t>(list.begin(), list.end()).size() == list.size());
    }
    CHECK(list == first);
  }
}

TEST_CASE("a restored snapshot goes on bit for bit, also in a fresh world") {
  World world;
  fill_scene(world);
  run(world, 25);
  ByteWriter snapshot;
  world.save(snapshot);
  const std::vector<std::uint64_t> ahead = hashes(world, 15);

  ByteReader again(snapshot.bytes());
  world.restore(again);
  CHECK(again.at_end());
  CHECK(hashes(world, 15) == ahead);

  World fresh;
  fill_scene(fresh);
  ByteReader into(snapshot.bytes());
  fresh.restore(into);
  CHECK(hashes(fresh, 15) == ahead);
}

TEST_CASE("a cut or foreign snapshot is refused") {
  World world;
  fill_scene(world);
  ByteWriter snapshot;
  world.save(snapshot);
  ByteReader cut(std::string_view(snapshot.bytes()).substr(0, 100));
  CHECK_THROWS_AS(world.restore(cut), InputError);
  World other;
  other.add_body(cube("one", 1.0, Vec3::Zero()));
  other.start();
  ByteReader foreign(snapshot.bytes());
  CHECK_THROWS_AS(other.restore(foreign), InputError);
}

TEST_CASE("a state that leaves the finite numbers names frame, group and body") {
  World world;
  world.add_body(cube("rocket", 1.0, Vec3::Zero()));
  world.parameters.simulation.gravity = Vec3(0, 1e4, 0);
  world.start();
  rigid(world, 0).velocity = Vec3(0, 9e14, 0);
  try {
    run(world, 5);
    FAIL("no error");
  } catch (const DivergenceError& e) {
    CHECK(std::string(e.what()).find("frame 1, group -1, body 'rocket'") != std::string::npos);
  }
}
