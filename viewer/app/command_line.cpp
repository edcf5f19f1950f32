// The one place that knows the parser of command lines.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>

#include "engine/core/parameter.hpp"
#include "engine/core/utf8.hpp"
#include "viewer/app/repeated_options.hpp"
#include "viewer/app/reserved_words.hpp"
#include "viewer/app/sub_command.hpp"

namespace impinge {

namespace {

int whole_number(std::string_view text, const std::string& what, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high)
    refuse_option(fmt::format("{} is '{}'", what, text),
                  fmt::format("a whole number from {} to {} is wanted", low, high), "change it");
  return value;
}

double real_number(const std::string& text, const std::string& what, double low, double high) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
    refuse_option(fmt::format("{} is '{}'", what, text), fmt::format("a number from {} to {} is wanted", low, high),
                  "change it");
  return value;
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const Entry<SubCommand>& command : sub_commands()) names.emplace_back(command.name);
  return names;
}

// before the parser sees them: words that are promised for later, and commands that are none
void refuse_reserved(const std::vector<std::string>& words) {
  if (words.empty()) return;
  const std::string& command = words[0];
  const auto later = reserved_commands();
  const std::vector<std::string> built = command_names();
  if (std::find(later.begin(), later.end(), command) != later.end())
    refuse_option(fmt::format("'{}' is not part of this version", command),
                  fmt::format("allowed: {}", fmt::join(built, ", ")), "use one of them");
  if (!command.starts_with('-') && std::find(built.begin(), built.end(), command) == built.end()) {
    std::vector<std::string> all = built;
    all.insert(all.end(), later.begin(), later.end());
    const std::string near = nearest_word(command, all);
    refuse_option(fmt::format("unknown sub-command '{}'", command), fmt::format("allowed: {}", fmt::join(built, ", ")),
                  near.empty() ? "see impinge --help" : fmt::format("did you mean '{}'?", near));
  }
  for (const ReservedOption& reserved : reserved_options())
    for (const std::string& word : words)
      if (command == reserved.command && word.substr(0, word.find('=')) == reserved.option)
        refuse_option(fmt::format("'{}' is not part of this version", reserved.option),
                      fmt::format("see impinge {} --help", command), "leave it out");
}

/// The option that stands more often than it may, as it was written, and how often; "" if none does.
std::string option_given_twice(const CLI::App& command, const std::vector<std::string>& words) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_expected_max() != 1 || option->count() < 2) continue;
    const auto is_it = [&](const std::string& word) { return option->check_name(word.substr(0, word.find('='))); };
    const auto first = std::find_if(words.begin(), words.end(), is_it);
    if (first == words.end() || std::none_of(first + 1, words.end(), is_it)) continue;
    return fmt::format("{} stands {}", first->substr(0, first->find('=')),
                       option->count() == 2 ? "twice" : fmt::format("{} times", option->count()));
  }
  return "";
}

// the parser's complaint on one line; for an option that isn't there, the nearest that is
std::string complaint(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& words) {
  std::string text = error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  const CLI::App* command = &app;
  for (const CLI::App* sub : app.get_subcommands()) command = sub;
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ArgumentMismatch))
    if (const std::string twice = option_given_twice(*command, words); !twice.empty())
      return fmt::format("command line: {}; it takes one value; leave the others out", twice);
  std::vector<std::string> options;
  for (const CLI::Option* option : command->get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (!word.starts_with("--") || std::find(options.begin(), options.end(), name) != options.end()) continue;
    if (const std::string near = nearest_word(name, options); !near.empty())
      return fmt::format("command line: unknown option '{}'; options of this command are wanted; did you mean '{}'?",
                         name, near);
  }
  return fmt::format("command line: {}; see impinge{} --help for what is allowed; mend the line", text,
                     command == &app ? "" : " " + command->get_name());
}

/// `help` and `help COMMAND` are --help and COMMAND --help.
std::vector<std::string> help_asked_as_command(std::vector<std::string> words) {
  if (words.empty() || words[0] != "help" || words.size() > 2) return words;
  words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

/// A command with the words that are for it.
struct Declared {
  std::unique_ptr<SubCommand> command;
  std::unique_ptr<Options> options;
  CLI::App* app;
};

int print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace

void refuse_option(const std::string& found, const std::string& allowed, const std::string& remedy) {
  throw InputError(fmt::format("command line: {}; {}; {}", found, allowed, remedy));
}

std::vector<std::string> names_between_commas(const std::string& text, const std::string& what) {
  std::vector<std::string> list(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_escaped = text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ',';
    if (is_escaped) ++i;
    if (text[i] == ',' && !is_escaped)
      list.emplace_back();
    else
      list.back() += text[i];
  }
  if (std::find(list.begin(), list.end(), "") != list.end())
    refuse_option(fmt::format("{} is '{}'", what, text), "names with commas between them are wanted",
                  "write them without gaps");
  return list;
}

void Options::word(const char* name, std::string& to, const std::string& doc) {
  app_.add_option(name, to, doc)->required();
}

void Options::word(const char* name, std::filesystem::path& to, const std::string& doc) {
  path(name, to, doc);
  app_.get_option(name)->required();
}

void Options::optional_word(const char* name, std::string& to, const std::string& doc) { text(name, to, doc); }
void Options::words(const char* name, std::vector<std::string>& to, const std::string& doc) {
  app_.add_option(name, to, doc)->required();
}

void Options::optional_word(const char* name, std::filesystem::path& to, const std::string& doc) {
  path(name, to, doc);
}

void Options::text(const char* name, std::string& to, const std::string& doc) { app_.add_option(name, to, doc); }

void Options::path(const char* name, std::filesystem::path& to, const std::string& doc) {
  other(
      name, [&to](const std::string& text) { to = text; }, doc);
}

void Options::texts(const char* name, std::vector<std::string>& to, const std::string& doc) {
  app_.add_option(name, to, doc)->take_all()->allow_extra_args(false);
}

void Options::two_texts(const char* name, std::pair<std::string, std::string>& to, const std::string& doc) {
  app_.add_option(name, to, doc)->required()->type_name("A B");
}

void Options::flag(const char* name, bool& to, const std::string& doc) { app_.add_flag(name, to, doc); }

void Options::flag_or_word(const char* name, const std::function<void(const std::string&)>& take,
                           const std::string& word, const std::string& doc) {
  const auto given = [=](const std::string& text) {
    if (text != "true" && text != word)
      refuse_option(fmt::format("{} is '{}'", name, text), fmt::format("{} or nothing is wanted", word),
                    fmt::format("write {}, or {}={}", name, name, word));
    take(text == word ? word : "");
  };
  texts_.emplace_back("", given);
  app_.add_flag(name, texts_.back().first, doc);
}

void Options::flag_off(const char* name, bool& to, const std::string& doc) {
  app_.add_flag_callback(
      name, [&to] { to = false; }, doc);
}

void Options::other(const char* name, std::function<void(const std::string&)> take, const std::string& doc) {
  texts_.emplace_back("", std::move(take));
  app_.add_option(name, texts_.back().first, doc);
}

void Options::whole(const char* name, const std::function<void(int)>& take, int low, int high, const std::string& doc) {
  other(
      name, [=](const std::string& text) { take(whole_number(text, name, low, high)); }, doc);
}

void Options::whole(const char* name, int& to, int low, int high, const std::string& doc) {
  whole(
      name, [&to](int value) { to = value; }, low, high, doc);
}

void Options::whole(const char* name, std::optional<int>& to, int low, int high, const std::string& doc) {
  whole(
      name, [&to](int value) { to = value; }, low, high, doc);
}

void Options::real(const char* name, double& to, double low, double high, const std::string& doc) {
  other(
      name, [=, &to](const std::string& text) { to = real_number(text, name, low, high); }, doc);
}

void Options::names(const char* name, std::vector<std::string>& to, const std::string& doc) {
  other(
      name, [=, &to](const std::string& text) { to = names_between_commas(text, name); }, doc);
}

void Options::name_lists(const char* name, std::vector<std::string>& to, const std::string& doc) {
  const auto take = [=, &to](const std::string& text) {
    for (std::string& one : names_between_commas(text, name)) to.push_back(std::move(one));
  };
  lists_.emplace_back(std::vector<std::string>(), take);
  texts(name, lists_.back().first, doc);
}

void Options::size(const char* name, const std::function<void(int, int)>& take, const std::string& doc) {
  const auto read = [=](const std::string& text) {
    const std::size_t x = text.find('x');
    if (x == std::string::npos)
      refuse_option(fmt::format("{} is '{}'", name, text), "WIDTHxHEIGHT is wanted",
                    fmt::format("write {} 1280x720", name));
    const int width = whole_number(text.substr(0, x), fmt::format("the width in {}", name), 16, 8192);
    take(width, whole_number(text.substr(x + 1), fmt::format("the height in {}", name), 16, 8192));
  };
  other(name, read, doc);
}

void Options::size(const char* name, int& width, int& height, const std::string& doc) {
  size(
      name, [&](int w, int h) { width = w, height = h; }, doc);
}

void Options::hidden(const char* name, std::string& to) { app_.add_option(name, to)->group(""); }

void Options::take() {
  for (const auto& [text, take] : texts_)
    if (!text.empty()) take(text);
  for (const auto& [texts, take] : lists_)
    for (const std::string& text : texts) take(text);
}

int run_command_line(int count, const char* const* words) {
  const std::vector<std::string> raw_words(words + std::min(count, 1), words + count);
  for (const std::string& word : raw_words)
    if (find_invalid_utf8(word) != std::string::npos)
      refuse_option(fmt::format("'{}' is not UTF-8", readable_utf8(word)),
                    "words and names of files in UTF-8 are wanted, since what is written names them",
                    "rename the file or folder");
  const std::vector<std::string> list = repeat_options(help_asked_as_command(raw_words));
  refuse_reserved(list);
  CLI::App app("impinge: collisions of bodies, simulated and shown");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("impinge ") + IMPINGE_VERSION);
  std::vector<Declared> all;
  for (const Entry<SubCommand>& entry : sub_commands()) {
    CLI::App* sub = app.add_subcommand(std::string(entry.name), std::string(entry.doc));
    all.push_back({entry.make(), std::make_unique<Options>(*sub), sub});
    all.back().command->declare(*all.back().options);
  }
  try {
    std::vector<const char*> all_words(words, words + std::min(count, 1));
    for (const std::string& word : list) all_words.push_back(word.c_str());
    app.parse(static_cast<int>(all_words.size()), all_words.data());
  } catch (const CLI::CallForHelp&) {
    const CLI::App* asked = &app;
    for (const CLI::App* sub : app.get_subcommands()) asked = sub;
    return print(asked == &app ? app.help() : asked->help("impinge"));
  } catch (const CLI::CallForVersion& version) {
    return print(std::string(version.what()) + "\n");
  } catch (const CLI::ParseError& error) {
    throw InputError(complaint(app, error, list));
  }
  for (const Declared& declared : all) {
    if (!declared.app->parsed()) continue;
    declared.options->take();
    return declared.command->run();
  }
  throw InternalError("no sub-command was read");
}

}  // namespace impinge
