// A sub-command: a file with its own options, and its line in all.cpp.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/registry.hpp"

namespace CLI {
class App;
}

namespace impinge {

/// What a command takes, declared word by word and bound to variables, which keep what they are where nothing is given.
/// A number that is none or out of its bounds is refused when all words are read. The parser is behind this.
class Options {
 public:
  explicit Options(CLI::App& app) : app_(app) {}
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

  // words by their place: SCENE, DIR
  void word(const char* name, std::string& to, const std::string& doc);
  void word(const char* name, std::filesystem::path& to, const std::string& doc);
  void optional_word(const char* name, std::string& to, const std::string& doc);
  void words(const char* name, std::vector<std::string>& to, const std::string& doc);  ///< one or more
  void optional_word(const char* name, std::filesystem::path& to, const std::string& doc);

  // words by their name: --out, --frames
  void text(const char* name, std::string& to, const std::string& doc);
  void path(const char* name, std::filesystem::path& to, const std::string& doc);
  void texts(const char* name, std::vector<std::string>& to, const std::string& doc);  ///< may be given several times
  void two_texts(const char* name, std::pair<std::string, std::string>& to, const std::string& doc);  ///< required
  void flag(const char* name, bool& to, const std::string& doc);
  /// A flag that may say more: --name alone, or --name=WORD.
  void flag_or_word(const char* name, const std::function<void(const std::string&)>& take, const std::string& word,
                    const std::string& doc);
  void flag_off(const char* name, bool& to, const std::string& doc);  ///< sets false
  void whole(const char* name, int& to, int low, int high, const std::string& doc);
  void whole(const char* name, std::optional<int>& to, int low, int high, const std::string& doc);
  void whole(const char* name, const std::function<void(int)>& take, int low, int high, const std::string& doc);
  void real(const char* name, double& to, double low, double high, const std::string& doc);
  /// Names with commas between them; a comma that belongs to a name is written \,.
  void names(const char* name, std::vector<std::string>& to, const std::string& doc);
  /// The same, and the option may be given several times.
  void name_lists(const char* name, std::vector<std::string>& to, const std::string& doc);
  /// What the program says to processes that it starts itself: in no --help.
  void hidden(const char* name, std::string& to);
  /// WIDTHxHEIGHT, pixels.
  void size(const char* name, int& width, int& height, const std::string& doc);
  void size(const char* name, const std::function<void(int width, int height)>& take, const std::string& doc);
  /// Anything else: `take` gets the text if there is one, and may throw InputError.
  void other(const char* name, std::function<void(const std::string&)> take, const std::string& doc);

  /// After all words are read: gives the variables what was said. Throws InputError.
  void take();

 private:
  CLI::App& app_;
  std::deque<std::pair<std::string, std::function<void(const std::string&)>>> texts_;
  std::deque<std::pair<std::vector<std::string>, std::function<void(const std::string&)>>> lists_;
};

class SubCommand {
 public:
  virtual ~SubCommand() = default;
  virtual void declare(Options& options) = 0;
  /// Prints what it has to say and returns the exit code. Throws InputError and DivergenceError.
  virtual int run() = 0;
};

/// All of them, in the order of --help.
const Registry<SubCommand>& sub_commands();

/// "command line: found; allowed; remedy", as an InputError.
[[noreturn]] void refuse_option(const std::string& found, const std::string& allowed, const std::string& remedy);

/// Reads the words (the first is the program's), and runs the command that they name. Throws InputError with one message
/// about the first thing that is wrong, and what the command throws.
int run_command_line(int count, const char* const* words);

}  // namespace impinge
