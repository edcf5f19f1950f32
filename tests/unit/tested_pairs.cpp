#include "engine/world/tested_pairs.hpp"

#include <catch2/catch.hpp>

#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("the pair of bodies without a test is the one that comparing all of them finds, asked by kind") {
  Random random(5);
  int found = 0;
  for (int round = 0; round < 500; ++round) {
    std::vector<RigidBody> bodies(static_cast<std::size_t>(random.below(12)));
    for (RigidBody& body : bodies) {
      const Shape shapes[] = {Plane(), Sphere(), Box(), Capsule(), MeshPointer()};
      body.shape = shapes[random.below(5)];
      body.kind = random.below(3) == 0   ? BodyKind::dynamic
                  : random.below(2) == 0 ? BodyKind::fixed
                                         : BodyKind::scripted;
    }
    bool untested[5][5] = {};
    for (int n = random.below(3); n > 0; --n) {
      const int k = random.below(5), l = random.below(5);
      untested[k][l] = untested[l][k] = true;
    }
    int asked = 0;
    const auto has_test = [&](const Shape& a, const Shape& b) {
      ++asked;
      return !untested[a.index()][b.index()];
    };
    std::optional<std::pair<int, int>> expected;
    for (int i = 0; i < std::ssize(bodies) && !expected; ++i)
      for (int j = i + 1; j < std::ssize(bodies) && !expected; ++j)
        if ((bodies[i].has_freedom() || bodies[j].has_freedom()) &&
            untested[bodies[i].shape.index()][bodies[j].shape.index()])
          expected = {i, j};
    CHECK(first_untested_pair(bodies, has_test) == expected);
    CHECK(asked <= 25);
    found += expected.has_value();
  }
  CHECK(found > 100);
}
