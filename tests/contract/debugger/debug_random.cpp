// Lines at random: what was recorded ends the same, and so does a bundle of the end where nothing else is left.
#include <fmt/format.h>

#include "tests/support/program/debug_session.hpp"
#include "tests/support/random.hpp"
#include "viewer/bundle/bundle.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::string line_at_random(Random& random) {
  const auto one_of = [&](const std::vector<std::string>& all) {
    return all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))];
  };
  switch (random.below(12)) {
    case 0:
    case 1:
      return fmt::format("set {} {}", one_of({"contact.friction", "body.ball.friction", "contact.restitution"}),
                         0.01 * random.below(100));
    case 2:
      return "undo";
    case 3:
      return "redo";
    case 4:
      return fmt::format("step {}", 1 + random.below(8));
    case 5:
      return fmt::format("back {}", 1 + random.below(8));
    case 6:
      return fmt::format("seek {}", random.below(40));
    case 7:
      return fmt::format("{} {} {}", one_of({"step", "back"}), one_of({"stage", "substep"}), 1 + random.below(30));
    case 8:
      return one_of({"hide crate", "show all", "isolate ball", "lock floor", "follow ball", "follow none",
                     "layer +aabbs", "layer -contacts", "camera orbit 20 5", "frame ball"});
    case 9:
      return one_of({"break when contacts > 2", "break when speed(ball) > 3", "break off", "find contacts > 1"});
    case 10:
      return one_of({"play", "pause", "ui wait 2", "ui click outliner/isolate", "panel sort bodies speed"});
    default:
      return fmt::format("ui drag parameters/contact.friction {}", 0.01 * random.below(100));
  }
}

}  // namespace

TEST_CASE("a session at random, its recording and a bundle of its end are one") {
  for (int seed = 1; seed <= 12; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    std::string lines = "panel front outliner\npanel front parameters\n";
    for (int k = 0; k < 60; ++k) {
      std::string line = line_at_random(random);
      if (line == "ui click outliner/isolate") line = "panel front outliner\n" + line + "\npanel front parameters";
      lines += line + "\n";
    }
    const TempFolder folder;
    folder.write("s.toml", kRigid);
    folder.write("a.script", lines + "bundle end.tar\n");
    INFO(lines);
    const Outcome made = debug(folder, "s.toml", "a.script", {"--record", "made.script"});
    INFO(made.err);
    REQUIRE(made.code == 0);
    CHECK(made.err.find("a bug") == std::string::npos);
    folder.write("again/a.script", slurp(folder / "made.script"));
    const Outcome again = debug(folder, "s.toml", "again/a.script", {"--out", "again", "--record", "again.script"});
    CHECK(again.out == made.out);
    const auto body = [](const std::string& text) { return text.substr(text.find('\n')); };
    CHECK(body(slurp(folder / "again.script")) == body(slurp(folder / "made.script")));
    const std::string one = slurp(folder / "end.tar"), other = slurp(folder / "again/end.tar");
    const Bundle first = parse_bundle("end.tar", one), second = parse_bundle("again/end.tar", other);
    CHECK(first.parts.size() == second.parts.size());
    // its console says in which line of the script a breakpoint stands
    for (const auto& [name, bytes] : first.parts)
      if (name != "picture.png") CHECK((second.parts.at(name) == bytes));  // not printed
    std::filesystem::remove(folder / "s.toml");
    folder.write("look.script", "ui wait 1\n");
    CHECK(debug(folder, "end.tar", "look.script").out == made.out);
    CHECK(impinge_run(folder.path(), {"replay", "end.tar"}).code == 0);
  }
}
