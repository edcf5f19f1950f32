// Fewer contacts carry the same: force and torque by their own sums, impulses never turned round.
#include "engine/contact/fewest_carriers.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace impinge;

namespace {

struct Sum {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // about the origin
  double size = 0.0;
};

Sum sum_of(const std::vector<CarriedImpulse>& impulses, const std::vector<double>& shares) {
  Sum sum;
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    sum.force += shares[i] * impulses[i].impulse;
    sum.torque += impulses[i].point.cross(shares[i] * impulses[i].impulse);
    sum.size += impulses[i].impulse.norm() * (1.0 + impulses[i].point.norm());
  }
  return sum;
}

std::size_t carriers(const std::vector<double>& shares) {
  return static_cast<std::size_t>(std::count_if(shares.begin(), shares.end(), [](double s) { return s != 0.0; }));
}

/// Of `most` asked for; returns how many carry.
std::size_t check(const std::vector<CarriedImpulse>& impulses, std::size_t most) {
  const std::vector<double> all(impulses.size(), 1.0), shares = fewer_carriers(impulses, most);
  const Sum before = sum_of(impulses, all), after = sum_of(impulses, shares);
  REQUIRE((before.force - after.force).norm() <= 1e-9 * before.size);
  REQUIRE((before.torque - after.torque).norm() <= 1e-9 * before.size);
  for (const double s : shares) REQUIRE(s >= 0.0);
  return carriers(shares);
}

/// All round a pin that leans in its hole, with friction.
std::vector<CarriedImpulse> round_a_pin(std::size_t count, std::mt19937& random, double friction) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<CarriedImpulse> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = M_PI * any(random);
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0), along = Vec3::UnitZ(), round = along.cross(out);
    const double size = std::pow(10.0, 3.0 * any(random));
    all.push_back({0.01 * out + (3.0 + 0.04 * any(random)) * along,
                   size * (out + 0.7 * friction * (any(random) * along + any(random) * round))});
  }
  return all;
}

}  // namespace

TEST_CASE("what sixty contacts round a pin carry, six can", "[contact][reduction]") {
  std::mt19937 random(3);
  for (const double friction : {0.0, 0.5})
    for (const std::size_t most : {30, 6, 0})
      for (int seed = 0; seed < 20; ++seed)
        CHECK(check(round_a_pin(60, random, friction), most) <= std::max<std::size_t>(most, 6));
}

TEST_CASE("four corners of a face without friction need three, and three are left alone", "[contact][reduction]") {
  std::vector<CarriedImpulse> corners;
  for (const auto& [x, z] : {std::pair(-1.0, -1.0), std::pair(1.0, -1.0), std::pair(1.0, 1.0), std::pair(-1.0, 1.0)})
    corners.push_back({Vec3(x, 2.0, z), Vec3(0.0, 1.0 + 0.2 * x, 0.0)});
  CHECK(check(corners, 1) == 3);
  corners.pop_back();
  CHECK(fewer_carriers(corners, 1) == std::vector<double>(3, 1.0));
  CHECK(fewer_carriers({}, 1).empty());
}

TEST_CASE("what carries least goes first, and nothing while few carry", "[contact][reduction]") {
  std::mt19937 random(5);
  const std::vector<CarriedImpulse> all = round_a_pin(20, random, 0.3);
  CHECK(fewer_carriers(all, 20) == std::vector<double>(20, 1.0));
  const std::vector<double> shares = fewer_carriers(all, 12);
  std::vector<double> gone, sizes;
  for (std::size_t i = 0; i < all.size(); ++i) {
    sizes.push_back(all[i].impulse.norm());
    if (shares[i] == 0.0) gone.push_back(sizes.back());
  }
  std::sort(sizes.begin(), sizes.end());
  CHECK(gone.size() == 8);
  CHECK(*std::max_element(gone.begin(), gone.end()) < sizes[16]);  // none of the four largest
}
