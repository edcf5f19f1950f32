// Attachments that slide: the same bits for any thread count, and from a snapshot in a fresh world.
#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/response_worlds.hpp"
#include "tests/support/mechanics/slides.hpp"
#include "tests/support/mechanics/state_hashes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Beads on a soft slab, on a ball that falls and on lines that both carry; a box falls on them all.
void fill(World& world, std::string_view response) {
  use(world, response);
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(soft_cube("slab", 0.3, 3, {0, 0.005, 0}, {5e4, 0.4, 1000.0, 0.01}));
  world.add_body(dynamic_body("ball", Sphere{0.1}, {0.6, 0.12, 0.1}));
  for (int i = 0; i < 4; ++i) {
    const bool soft = i % 2 == 0;
    const Vec3 at = soft ? Vec3(0.1 + 0.03 * i, 0.305, 0.12) : Vec3(0.6, 0.22, 0.1);
    const std::string name = "bead" + std::to_string(i);
    world.add_body(cube(name, 0.02, at));
    world.add_attachment(slide(i < 2 ? AttachmentKind::surface : AttachmentKind::line, name, soft ? "slab" : "ball", at,
                               Vec3(1.0, 0.1, 0.2)));
  }
  world.add_body(cube("box", 0.15, {0.2, 0.5, 0.15}));
  world.start();
}

}  // namespace

TEST_CASE("what slides has the same hashes for 1, 2 and 4 threads, for every response") {
  for (const auto& response : responses()) {
    CAPTURE(response.name);
    std::vector<std::uint64_t> first;
    for (int threads : {1, 2, 4}) {
      const Threads guard(threads);
      World world;
      fill(world, response.name);
      const std::vector<std::uint64_t> list = hashes(world, 12);
      if (first.empty()) first = list;
      CHECK(list == first);
    }
  }
}

TEST_CASE("what slides goes on from a snapshot as if nothing had been, its records too") {
  World world, other;
  fill(world, "constraint_anticipation");
  fill(other, "constraint_anticipation");
  run(world, 10);
  ByteWriter state;
  world.save(state);
  ByteReader in(state.bytes());
  other.restore(in);
  for (std::size_t i = 0; i < world.record().attachments.size(); ++i) {
    const AttachmentRecord &a = link_of(world, i), &b = link_of(other, i);
    CHECK((a.kind == b.kind && a.point_a == b.point_a && a.point_b == b.point_b && a.axis == b.axis));
    CHECK(a.impulse == b.impulse);
  }
  CHECK(hashes(world, 10) == hashes(other, 10));
}
