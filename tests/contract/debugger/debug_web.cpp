// The debugger served to browsers: a real one (Chromium, driven through its own protocol) sees what the same session shows
// without a screen, in every pixel; who has no password or speaks nonsense sees nothing and breaks nothing.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <signal.h>

#include <chrono>
#include <regex>
#include <thread>

#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const fs::path kScene = fs::path(IMPINGE_SOURCE_DIR) / "tests/images/suite/crate_and_ball.toml";

/// Where it listens, from what it prints; "" if it does not within a minute.
std::string address_of(const RunningProgram& server) {
  for (int k = 0; k < 600; ++k) {
    std::smatch found;
    const std::string text = server.err();
    if (std::regex_search(text, found, std::regex("web: (http://[^ ]*/)"))) return found[1];
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return "";
}

int differing_pixels(const Image& a, const Image& b) {
  REQUIRE(a.rgb.size() == b.rgb.size());
  int differing = 0;
  for (std::size_t k = 0; k < a.rgb.size(); k += 3) differing += !std::equal(&a.rgb[k], &a.rgb[k] + 3, &b.rgb[k]);
  return differing;
}

}  // namespace

TEST_CASE("a browser shows and works the debugger, in every pixel as without a screen, and rude clients do no harm") {
  const TempFolder folder;
  folder.write("secret", "open-sesame-42\n");
  {
    RunningProgram server(folder.path(), {"debug", kScene.string(), "--web", "0", "--password-file", "secret", "--size",
                                          "960x600", "--record", "hand.script"});
    const std::string address = address_of(server);
    INFO(server.err());
    REQUIRE(address.starts_with("http://127.0.0.1:"));
    CHECK(server.err().find("open-sesame") == std::string::npos);
    const Outcome used = program_run("/usr/bin/python3", folder.path(),
                                     {fmt::format("{}/tests/tools/debugger_in_browser.py", IMPINGE_SOURCE_DIR), address,
                                      "open-sesame-42", folder.path().string()});
    if (used.code == 77 || used.code == 127) {
      WARN("not opened: this test needs python3 and chromium");
      return;
    }
    INFO(used.out << used.err);
    CHECK(used.code == 0);
    CHECK_FALSE(server.has_ended());
    server.signal(SIGTERM);
    CHECK(server.wait().code == 130);
  }
  std::string script = slurp(folder / "hand.script");
  INFO(script);
  for (const char* part : {"\ncamera eye ", "\nstep 3\n"}) CHECK(script.find(part) != std::string::npos);
  folder.write("again.script", "shot before_wanted.png\n" + script + "shot after_wanted.png\n");
  const Outcome replay = impinge_run(
      folder.path(), {"debug", kScene.string(), "--headless", "--script", "again.script", "--size", "960x600"});
  INFO(replay.err);
  REQUIRE(replay.code == 0);
  CHECK(differing_pixels(read_png(folder / "before.png"), read_png(folder / "before_wanted.png")) == 0);
  CHECK(differing_pixels(read_png(folder / "after.png"), read_png(folder / "after_wanted.png")) == 0);
}

TEST_CASE("what can't be served is refused before anything is simulated") {
  const TempFolder folder;
  folder.write("short", "abc\n");
  folder.write("blank", "with a blank\n");
  const auto refused = [&](std::vector<std::string> words, const std::string& part) {
    words.insert(words.begin(), {"debug", kScene.string()});
    const Outcome outcome = impinge_run(folder.path(), words);
    CAPTURE(words, outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find(part) != std::string::npos);
  };
  refused({"--web", "70000"}, "--web");
  refused({"--web", "0", "--headless"}, "--web or --vnc with --headless");
  refused({"--listen", "0.0.0.0", "--headless"}, "--listen without --web or --vnc");
  refused({"--web", "0", "--listen", "localhost"}, "an address in numbers is wanted");
  refused({"--web", "0", "--listen", "8.8.8.8"}, "can't be listened on");
  refused({"--web", "0", "--password-file", "short"}, "short:1: a line of 3 characters");
  refused({"--web", "0", "--password-file", "blank"}, "blank:1: a line with blanks");
  refused({"--web", "0", "--password-file", "missing"}, "missing");
  folder.write("long", "123456789\n");
  refused({"--vnc", "5999", "--password-file", "long"}, "VNC looks at the first 8 only");
  refused({"--vnc", "5999", "--web", "5999"}, "each wants its own");
}
