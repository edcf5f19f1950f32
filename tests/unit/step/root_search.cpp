// Where Newton iterations with contact go on, on maps whose fixed points are known.
#include <catch2/catch.hpp>

#include <functional>

#include "engine/step/roots/root_search.hpp"

using namespace impinge;

namespace {

using Map = std::function<VecX(const VecX&)>;

constexpr double kSmall = 1e-9;
constexpr int kMost = 50;

/// A of two nodes that are joined.
BlockMatrix metric() {
  const std::array<int, 4> both{0, 1, 0, 1};
  BlockMatrix a(std::make_shared<const BlockPattern>(make_block_pattern(2, std::span(&both, 1))));
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      a.values[static_cast<std::size_t>(a.pattern->find(i, j))] = (i == j ? 2.0 : -0.5) * Mat3::Identity();
  return a;
}

struct Outcome {
  VecX at, best;
  double least = INFINITY;  // way from any place since steps were not full
  int tried = 0;
  bool is_found = false, is_controlled = false, is_always_full = true;
};

Outcome search_root(const Map& map, const VecX& start) {
  const BlockMatrix a = metric();
  const BlockMatrix* const list[] = {&a};
  RootSearch search(kSmall, kMost);
  Outcome out;
  out.at = start;
  for (; out.tried < kMost; ++out.tried) {
    const VecX to = map(out.at);
    const double residual = (to - out.at).norm();
    if (out.is_controlled) out.least = std::min(out.least, residual);
    out.is_found = residual <= kSmall;
    if (out.is_found) break;
    const RootSearch::Velocities next = search.next({out.at}, {to}, residual, list);
    out.is_always_full &= next[0] == to;
    out.is_controlled = search.is_controlled();
    out.at = next[0];
  }
  if (!search.best().empty()) out.best = search.best()[0];
  return out;
}

const VecX kTarget = (VecX(6) << 1.0, -2.0, 0.5, 0.0, 3.0, -0.7).finished();
const VecX kStart = (VecX(6) << 0.3, 0.1, -0.4, 2.0, -1.0, 0.9).finished();

}  // namespace

TEST_CASE("root search: full steps that get on are taken as they are, to the bit") {
  const Outcome out = search_root([](const VecX& v) { return VecX(kTarget + 0.3 * (v - kTarget)); }, kStart);
  CHECK(out.is_found);
  CHECK(out.is_always_full);
  CHECK(!out.is_controlled);
  CHECK((out.at - kTarget).norm() <= 2.0 * kSmall);
}

TEST_CASE("root search: a map that throws to the other side, or creeps, is brought to its root") {
  for (const double slope : {-1.0, -1.3, -2.5, -0.95, 0.95}) {
    CAPTURE(slope);
    const auto map = [&](const VecX& v) {
      VecX to = kTarget;
      for (int i = 0; i < 6; ++i) to[i] += slope * (1.0 - 0.1 * i) * (v[i] - kTarget[i]);
      return to;
    };
    const Outcome out = search_root(map, kStart);
    CHECK(out.is_controlled);
    CHECK(out.is_found);
    CHECK((out.at - kTarget).norm() <= 100.0 * kSmall);
  }
}

TEST_CASE("root search: kinks, as contacts that open and close make them, and forces that turn round") {
  // v = c − 1.6 max(v, 0): c/2.6 where c > 0, else c
  const auto kink = [](const VecX& v) { return VecX(kTarget - 1.6 * v.cwiseMax(0.0)); };
  VecX root = kTarget;
  for (int i = 0; i < 6; ++i)
    if (root[i] > 0.0) root[i] /= 2.6;
  const Outcome kinked = search_root(kink, kStart);
  CHECK(kinked.is_controlled);
  CHECK(kinked.is_found);
  CHECK((kinked.at - root).norm() <= 100.0 * kSmall);
  // round in four
  const auto turned = [](const VecX& v) {
    VecX to = kTarget;
    for (int i = 0; i < 6; i += 2) to[i] -= v[i + 1] - kTarget[i + 1], to[i + 1] += v[i] - kTarget[i];
    return to;
  };
  const Outcome round = search_root(turned, kStart);
  CHECK(round.is_controlled);
  CHECK(round.is_found);
  CHECK((round.at - kTarget).norm() <= 100.0 * kSmall);
}

TEST_CASE("root search: of what has no root it knows the place that came nearest") {
  const auto jump = [](const VecX& v) {
    return VecX(v.unaryExpr([](double x) { return x > 0.1 ? x - 1.0 : x + 0.7; }));
  };
  const Outcome out = search_root(jump, kStart);
  CHECK(out.is_controlled);
  CHECK(!out.is_found);
  REQUIRE(out.best.size() == 6);
  CHECK(out.best.allFinite());
  CHECK((jump(out.best) - out.best).norm() == out.least);
}
