// States kept for going back, held against a plain list of everything that was put and cut.
#include <catch2/catch.hpp>

#include <map>

#include "tests/support/random.hpp"
#include "viewer/debugger/snapshot_ring.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("the states kept stay in their bound, and one at or before any frame is found") {
  Random random(6);
  for (int run = 0; run < 40; ++run) {
    CAPTURE(run);
    const auto most = static_cast<std::size_t>(random.in(200, 4000));
    SnapshotRing ring(most);
    std::map<int, std::string> all;  // the last state put of each frame
    int frame = 0, last = 0;
    for (int deed = 0; deed < 600; ++deed) {
      if (deed > 0 && random.u() < 0.03) {  // back, and either on again or with another future
        frame = random.below(last + 1);
        if (random.u() < 0.5) {
          ring.cut(frame);
          all.erase(all.upper_bound(frame), all.end());
          last = frame;
        }
      } else if (deed > 0) {
        ++frame;
      }
      std::string state(static_cast<std::size_t>(random.in(10, 90)), static_cast<char>('a' + random.below(26)));
      all[frame] = state;
      ring.put(frame, std::move(state));
      last = std::max(last, frame);

      std::size_t bytes = 0, count = 0;
      int latest = -1;
      for (const auto& [k, put] : all) {
        if (ring.has(k)) {
          ++count, bytes += put.size(), latest = k;
          REQUIRE(ring.state(k) == put);
        }
        const std::optional<int> found = ring.at_or_before(k);
        REQUIRE(found);
        REQUIRE(*found == latest);  // none that is later, none that is cut or forgotten
      }
      REQUIRE(ring.bytes() == bytes);
      REQUIRE(ring.count() == count);
      REQUIRE((bytes <= most || count <= 2));
      REQUIRE(ring.has(0));
      REQUIRE(ring.has(last));
      REQUIRE_FALSE(ring.has(last + 1));
    }
    CHECK(static_cast<int>(ring.count()) < last + 1);  // something had to go
  }
}

TEST_CASE("states lie close together near the present and ever farther apart before it") {
  SnapshotRing ring(100 * 64);
  for (int frame = 0; frame <= 10'000; ++frame) ring.put(frame, std::string(64, 'x'));
  CHECK(ring.count() == 100);
  for (int frame = 0; frame <= 10'000; ++frame) {
    const int remade = frame - *ring.at_or_before(frame), past = 10'000 - frame;
    REQUIRE(remade <= 5 + past / 4);
  }
}
