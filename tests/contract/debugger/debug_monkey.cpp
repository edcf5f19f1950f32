// Hands that know nothing: mouse, wheel, keys and words anywhere. Nothing they do ends the debugger, and their recording
// makes the same states.
#include <fmt/format.h>

#include "tests/support/program/debug_session.hpp"
#include "tests/support/random.hpp"
#include "viewer/panels/debug/ui.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

template <class T>
const T& one_of(Random& random, const std::vector<T>& all) {
  return all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))];
}

/// For the console, or whatever has the keyboard: lines that are right, nearly right, and noise.
std::string words(Random& random) {
  static const std::vector<std::string> kLines = {"set contact.friction 0.3",
                                                  "set contact.friction",
                                                  "set body.ball.friction -1",
                                                  "set nothing 3",
                                                  "hide crate",
                                                  "hide nobody",
                                                  "show all",
                                                  "layer +aabbs",
                                                  "layer +none",
                                                  "step 2",
                                                  "back 1",
                                                  "seek 4",
                                                  "step stage 3",
                                                  "undo",
                                                  "redo",
                                                  "break when contacts > 1",
                                                  "break when ((",
                                                  "break off",
                                                  "why crate floor",
                                                  "why crate crate",
                                                  "select contact 99999",
                                                  "select body ball 0",
                                                  "panel sort bodies mass",
                                                  "camera orbit 1e9 nan",
                                                  "follow ball",
                                                  "seek -1",
                                                  "step 99999999999999999999",
                                                  "at 3 set contact.friction 1",
                                                  "find contacts > 1",
                                                  "ghost"};
  if (random.below(3) > 0) return one_of(random, kLines);
  std::string noise;
  for (int k = 1 + random.below(30); k > 0; --k) noise += static_cast<char>(' ' + random.below(95));
  return "x" + noise + "x";  // blanks at the ends of a line are nobody's
}

std::string event(Random& random) {
  switch (random.below(10)) {
    case 0:
    case 1:
    case 2:
      return fmt::format("ui move {} {}", random.below(860) - 30, random.below(560) - 30);
    case 3:
    case 4:
      return "ui press " + one_of(random, button_names());
    case 5:
    case 6:
      return "ui release " + one_of(random, button_names());
    case 7:
      return fmt::format("ui wheel {}", random.below(9) - 4);
    case 8:
      return "ui key " + one_of(random, key_names());
    default:
      return "ui text " + words(random) + (random.below(2) == 0 ? "\nui key enter" : "");
  }
}

void let_loose(std::uint64_t seed, int events) {
  CAPTURE(seed);
  Random random(seed);
  std::string lines;
  for (int k = 0; k < events; ++k) lines += event(random) + "\n";
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", lines);
  const Outcome made =
      debug(folder, "s.toml", "a.script", {"--record", "made.script", "--size", "800x500", "--memory", "4"});
  INFO(made.err);
  REQUIRE(made.code == 0);
  CHECK(made.err.find("a bug") == std::string::npos);
  folder.write("again/a.script", slurp(folder / "made.script"));
  const Outcome again = debug(folder, "s.toml", "again/a.script", {"--size", "800x500"});
  INFO(again.err);
  CHECK(again.out == made.out);
}

}  // namespace

TEST_CASE("a monkey at the debugger leaves a recording that replays") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) let_loose(seed, 150);
}

TEST_CASE("100,000 events of a monkey leave recordings that replay", "[long]") {
  for (std::uint64_t seed = 100; seed < 200; ++seed) let_loose(seed, 1000);
}
