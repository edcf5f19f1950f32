#include "engine/core/shell_word.hpp"

#include <catch2/catch.hpp>

#include <cstdio>
#include <string>

using namespace impinge;

namespace {

/// What sh makes of it.
std::string said_by_shell(const std::string& word) {
  std::FILE* pipe = popen(("printf %s " + word).c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  pclose(pipe);
  return text;
}

}  // namespace

TEST_CASE("a word for the shell is read back by it as it was, and plain where that is safe") {
  for (const char* text :
       {"a b.toml", "it's", "$HOME", "`date`", "a\\b", "x=1", "*", "~", "", "#a", "a;b", "\"q\"", "ä"}) {
    CAPTURE(text);
    CHECK(said_by_shell(shell_word(text)) == text);
    CHECK(shell_word(text).front() == '\'');
  }
  for (const char* text : {"out/drop/run.toml", "../a-b_c.script", "1280x720"}) CHECK(shell_word(text) == text);
}
