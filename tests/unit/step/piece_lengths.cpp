// What the pieces of a sub-step try, against a way on which something stands at known places.
#include "engine/step/cuts/piece_lengths.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <vector>

using namespace impinge;

namespace {

constexpr int kMostPieces = 64;
constexpr double kLeastShare = 1e-4;

struct Way {
  int pieces = 0;
  double in_vain = 0.0;  // sum of shares of motions that were made anew
};

/// Goes on until 1. A motion over one of `places` is cut there; each has so many contacts.
Way go(const std::vector<double>& places, std::size_t contacts) {
  PieceLengths lengths(kMostPieces, kLeastShare);
  Way way;
  double done = 0.0, next = 1.0;
  while (done < 1.0 && way.pieces < 10 * kMostPieces) {
    double share = std::min(next, 1.0 - done);
    const auto ahead = std::upper_bound(places.begin(), places.end(), done + 1e-12);
    if (ahead != places.end() && done + share > *ahead + 1e-12) {
      way.in_vain += share;
      lengths.made_in_vain(contacts), lengths.cut();
      share = *ahead - done;
    }
    done = share >= 1.0 - done ? 1.0 : done + share;
    ++way.pieces;
    next = lengths.next(1.0, 1.0 - done);
  }
  return way;
}

std::vector<double> every(double step) {
  std::vector<double> places;
  for (int k = 1; k * step < 1.0 - 1e-9; ++k) places.push_back(k * step);
  return places;
}

}  // namespace

TEST_CASE(
    "where few bodies meet each piece tries all that is left, and where much was in vain twice what went well at "
    "most") {
  const Way few = go(every(0.05), 8), many = go(every(0.05), 4000), some = go(every(0.05), 400);
  CHECK(few.pieces == 20);
  CHECK(few.in_vain == Approx(0.05 * (20 * 21 / 2 - 1)));  // 1 + 0.95 + ... + 0.1
  CHECK(many.pieces <= 21);
  CHECK(many.in_vain < 0.25 * few.in_vain);
  CHECK(some.in_vain > many.in_vain);
  CHECK(some.in_vain < few.in_vain);
}

TEST_CASE("a sub-step of many bodies ends within its pieces however short one of them was") {
  for (const double first : {1e-9, 1e-6, 1e-3, 0.5}) {
    CAPTURE(first);
    const Way way = go({first}, 4000);
    CHECK(way.pieces < kMostPieces);
  }
  CHECK(go({}, 4000).pieces == 1);
}
