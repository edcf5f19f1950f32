#include "engine/response/pair_colours.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void check(const std::vector<BodyPlaces>& pairs, int bodies) {
  const PairColours colours = colour_pairs(pairs, bodies);
  std::vector<int> sorted = colours.order;
  std::sort(sorted.begin(), sorted.end());
  REQUIRE(sorted.size() == pairs.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) REQUIRE(sorted[i] == static_cast<int>(i));
  REQUIRE(colours.begin.front() == 0);
  REQUIRE(colours.begin.back() == static_cast<int>(pairs.size()));
  bool grounded = false;
  for (std::size_t c = 0; c + 1 < colours.begin.size(); ++c) {
    if (colours.last_is_rest && c + 2 == colours.begin.size()) break;
    std::set<int> taken;
    for (int k = colours.begin[c]; k < colours.begin[c + 1]; ++k) {
      const auto& [a, b] = pairs[colours.order[k]];
      for (const int body : {a, b}) CHECK((body < 0 || taken.insert(body).second));
      const bool is_grounded = a < 0 || b < 0;
      CHECK((is_grounded || !grounded));  // those on the ground come last
      grounded = grounded || is_grounded;
    }
  }
}

}  // namespace

TEST_CASE("pairs of one colour have no body in common, and those on the ground come last") {
  Random random(12);
  for (const int bodies : {1, 2, 10, 200}) {
    std::vector<BodyPlaces> pairs;
    for (int i = 0; i < 3 * bodies; ++i) {
      const int a = random.below(bodies), b = i % 5 == 0 ? -1 : random.below(bodies);
      if (a != b) pairs.emplace_back(a, b);
    }
    CAPTURE(bodies);
    check(pairs, bodies);
    const PairColours colours = colour_pairs(pairs, bodies);
    CHECK_FALSE(colours.last_is_rest);
    CHECK(pairs[colours.order.back()].second < 0);
  }
}

TEST_CASE("a body of a hundred pairs leaves a rest that is gone through one by one") {
  std::vector<BodyPlaces> pairs;
  for (int i = 1; i <= 100; ++i) pairs.emplace_back(0, i);
  check(pairs, 101);
  CHECK(colour_pairs(pairs, 101).last_is_rest);
  CHECK_FALSE(colour_pairs(std::vector<BodyPlaces>{{0, 1}, {1, 2}}, 3).last_is_rest);
}
