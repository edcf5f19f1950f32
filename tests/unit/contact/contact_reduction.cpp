// What stays of a pair's contacts allows the same motions: the smallest gap over all contacts after any small motion is the
// smallest over those that stayed.
#include "engine/contact/contact_reduction.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace impinge;

namespace {

Collision contact_at(const Vec3& point, const Vec3& normal, double gap, std::uint64_t feature) {
  Collision c;
  c.body_a = BodyIndex(0), c.body_b = BodyIndex(1);
  c.point_a = point + 0.5 * gap * normal, c.point_b = point - 0.5 * gap * normal;
  c.normal = normal;
  c.gap = gap;
  c.feature = feature;
  return c;
}

std::vector<Collision> that_stay(const std::vector<Collision>& all, int most = 40) {
  const std::vector<char> stays = contacts_that_stay(all, std::vector<char>(all.size(), 0), {1e-3, most});
  std::vector<Collision> kept;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (stays[i] != 0) kept.push_back(all[i]);
  return kept;
}

double smallest_gap(const std::vector<Collision>& contacts, const Vec3& shift, const Vec3& turn) {
  double least = INFINITY;
  for (const Collision& c : contacts)
    least = std::min(least, c.gap + c.normal.dot(shift + turn.cross(0.5 * (c.point_a + c.point_b))));
  return least;
}

/// How much deeper than what stayed shows any contact lies, over random small motions.
double unseen_depth(const std::vector<Collision>& all, const std::vector<Collision>& kept, double shift, double turn) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < 2000; ++i) {
    Vec3 v, w;
    for (int k = 0; k < 3; ++k) v[k] = shift * coordinate(random), w[k] = turn * coordinate(random);
    worst = std::max(worst, smallest_gap(kept, v, w) - smallest_gap(all, v, w));
  }
  return worst;
}

}  // namespace

TEST_CASE("of the 81 corners of a flat face four contacts stay, and any motion sees the same depth",
          "[contact][reduction]") {
  for (const double turn : {0.0, 0.3, 1.1}) {
    std::vector<Collision> all;
    for (int i = 0; i <= 8; ++i)
      for (int k = 0; k <= 8; ++k) {
        const double x = 0.1 * (i / 8.0 - 0.5), z = 0.1 * (k / 8.0 - 0.5);
        const Vec3 at(std::cos(turn) * x - std::sin(turn) * z, 0.2, std::sin(turn) * x + std::cos(turn) * z);
        all.push_back(contact_at(at, Vec3::UnitY(), 0.0, all.size()));
      }
    const std::vector<Collision> kept = that_stay(all);
    CHECK(kept.size() == 4);
    CHECK(unseen_depth(all, kept, 0.01, 0.5) <= 1e-12);
  }
}

TEST_CASE("a corner that stands out below a face stays beside the support polygon", "[contact][reduction]") {
  std::vector<Collision> all;
  for (int i = 0; i <= 6; ++i)
    for (int k = 0; k <= 6; ++k)
      all.push_back(contact_at({0.1 * i, 0.0, 0.1 * k}, Vec3::UnitY(), i == 2 && k == 3 ? -1e-4 : 5e-4, all.size()));
  const std::vector<Collision> kept = that_stay(all);
  CHECK(kept.size() == 5);
  CHECK(std::any_of(kept.begin(), kept.end(), [](const Collision& c) { return c.gap < 0.0; }));
}

TEST_CASE("a disc keeps 16 corners of its rim", "[contact][reduction]") {
  std::vector<Collision> all;
  const double radius = 0.05;
  for (int i = 0; i < 500; ++i) {
    const double angle = 2.0 * M_PI * i / 500;
    all.push_back(
        contact_at({radius * std::cos(angle), 0.0, radius * std::sin(angle)}, Vec3::UnitY(), 0.0, all.size()));
  }
  const std::vector<Collision> kept = that_stay(all);
  CHECK(kept.size() <= 24);  // and the tilts' eight
  // a turn lowers the rim by radius·|turn|, and sixteen corners evenly round it by cos(180°/16) = 0.981 of that
  CHECK(unseen_depth(all, kept, 0.0, 0.1) <= 0.025 * radius * 0.1 * std::sqrt(2.0));
}

TEST_CASE("a pin in a hole keeps at most 40 contacts, and small motions see its depth", "[contact][reduction]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(0.0, 1e-6);
  const double radius = 0.01, play = 1e-4;
  for (const int sides : {16, 64, 200}) {
    std::vector<Collision> all;
    for (int i = 0; i < sides; ++i)
      for (int end = 0; end < 5; ++end) {
        const double angle = 2.0 * M_PI * i / sides;
        const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
        all.push_back(contact_at(radius * out + Vec3(0, 0, 0.01 * end), -out, play * (1.0 - out.x()) + noise(random),
                                 all.size()));
      }
    const std::vector<Collision> kept = that_stay(all);
    CAPTURE(sides, kept.size());
    CHECK(kept.size() <= 40);
    CHECK(unseen_depth(all, kept, play, 0.0) <= 0.2 * play);
    for (const int most : {30, 12}) {  // what has farthest to go waits
      const std::vector<Collision> few = that_stay(all, most);
      CAPTURE(most, few.size());
      CHECK(few.size() <= static_cast<std::size_t>(most));
      CHECK(unseen_depth(all, few, 0.1 * play, 0.0) <= 0.1 * play);
    }
  }
}

TEST_CASE("contacts that carry stay the same when gaps differ by noise", "[contact][reduction]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> noise(-1e-9, 1e-9);
  std::vector<char> carries(400, 0);
  std::vector<char> first;
  for (int step = 0; step < 50; ++step) {
    std::vector<Collision> all;  // a cap of a ball of many corners that lies on the ground
    for (int i = 0; i < 400; ++i) {
      const double r = 0.003 * std::sqrt((i + 0.5) / 400), angle = 2.399963229728653 * i;
      all.push_back(contact_at({r * std::cos(angle), 0.0, r * std::sin(angle)}, Vec3::UnitY(),
                               r * r / 0.2 + noise(random), all.size()));
    }
    const std::vector<char> stays = contacts_that_stay(all, carries, {});
    if (step == 0) first = stays;
    CHECK(stays == first);
    carries = stays;
  }
}
