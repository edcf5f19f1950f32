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
                                                  "pull crate 0.5 0.25 0.5 to 1 2 0",
                                                  "pull ball 0 0.3 0 to 0 1e6 0 stiffness 1e9",
                                                  "pull floor 0 0 0 to 1 1 1",
                                                  "release crate",
                                                  "release ball",
                                                  "push ball 3 0 nan",
                                                  "push ball 0 40 0",
                                                  "push crate 1 2 3 at 0 0 1e9",
                                                  "move crate 0 1 0 turn 0 0 1 90",
                                                  "move ball 0 0",
                                                  "delete crate",
                                                  "delete floor",
                                                  "add ball_2 like ball at 0 2 0",
                                                  "add crate_2 like crate at 0.3 1.5 0 turn 1 0 0 30",
                                                  "add ball_3 like ball_2 at 0 9 nan",
                                                  "push ball_2 10 0 0",
                                                  "delete ball_2",
                                                  "ghost"};
  if (random.below(3) > 0) return one_of(random, kLines);
  std::string noise;
  for (int k = 1 + random.below(30); k > 0; --k) {
    const char c = static_cast<char>(' ' + random.below(95));
    // what a word begins with a script wants closed; typed into the console it may stand anywhere else
    const bool opens = (noise.empty() || noise.back() == ' ') && (c == '"' || c == '\'' || c == '[');
    noise += opens ? 'x' : c;
  }
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
      return "ui key " + one_of(random, key_names()) + one_of(random, std::vector<std::string>{"", "", " down", " up"});
    default:
      return "ui text " + words(random) + (random.below(2) == 0 ? "\nui key enter" : "");
  }
}

struct Session {
  Outcome made, again;  ///< by hand, and by its recording
};

Session let_loose(std::uint64_t seed, int events) {
  Random random(seed);
  std::string lines;
  for (int k = 0; k < events; ++k) lines += event(random) + "\n";
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", lines);
  Session session;
  session.made = debug(folder, "s.toml", "a.script", {"--record", "made.script", "--size", "800x500", "--memory", "4"});
  if (session.made.code != 0) return session;
  folder.write("again/a.script", slurp(folder / "made.script"));
  session.again = debug(folder, "s.toml", "again/a.script", {"--size", "800x500"});
  return session;
}

/// What went wrong in as many sessions of so many events; empty: nothing.
std::string trouble(std::uint64_t first_seed, int sessions, int events) {
  for (std::uint64_t seed = first_seed; seed < first_seed + static_cast<std::uint64_t>(sessions); ++seed) {
    const auto [made, again] = let_loose(seed, events);
    const bool is_well = made.code == 0 && again.code == 0 && made.out == again.out && !made.out.empty() &&
                         made.err.find("a bug") == std::string::npos;
    if (!is_well)
      return fmt::format("seed {}: exit {}, {}{}; again exit {}, {}{}", seed, made.code, made.out, made.err, again.code,
                         again.out, again.err);
  }
  return "";
}

}  // namespace

TEST_CASE("a monkey at the debugger leaves a recording that replays") { CHECK(trouble(1, 3, 150) == ""); }

// 100,000 in four parts, for as many cores
TEST_CASE("25,000 events of a monkey leave recordings that replay", "[long]") { CHECK(trouble(100, 25, 1000) == ""); }
TEST_CASE("25,000 events of a second monkey do", "[long]") { CHECK(trouble(125, 25, 1000) == ""); }
TEST_CASE("25,000 events of a third monkey do", "[long]") { CHECK(trouble(150, 25, 1000) == ""); }
TEST_CASE("25,000 events of a fourth monkey do", "[long]") { CHECK(trouble(175, 25, 1000) == ""); }
