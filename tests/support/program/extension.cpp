#include "tests/support/program/extension.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace impinge::test {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The last path to a source file in back quotes; `before` where there is none.
std::string last_path(const std::string& line, std::string before) {
  for (std::size_t begin = line.find('`'); begin != std::string::npos;) {
    const std::size_t end = line.find('`', begin + 1);
    if (end == std::string::npos) break;
    const std::string word = line.substr(begin + 1, end - begin - 1);
    if (word.ends_with(".cpp") && (word.starts_with("engine/") || word.starts_with("viewer/"))) before = word;
    begin = line.find('`', end + 1);
  }
  return before;
}

/// What lines of a list have in common: up to the first bracket or quote.
std::string beginning(const std::string& line) { return line.substr(0, line.find_first_of("(\"") + 1); }

/// Before the end of the list whose last line begins like the new one.
std::string behind_its_like(const std::string& text, const std::string& line) {
  const std::size_t at = text.rfind("\n" + beginning(line));
  if (at == std::string::npos) throw std::runtime_error("no line begins like " + line);
  const std::size_t end = 1 + std::min(text.find("\n};", at), text.find("\n    return", at));
  return text.substr(0, end) + line + text.substr(end);
}

void replace(std::string& text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("no '" + what + "' in the command " + text);
  text.replace(at, what.size(), by);
}

/// How the build compiles a file.
struct Compilation {
  std::string command, output;
};
Compilation compilation_of(const std::string& file) {
  // one key a line, as CMake writes it
  const std::string wanted = "\"file\": \"" + (fs::path(IMPINGE_SOURCE_DIR) / file).string() + "\"";
  const auto value = [](const std::string& line) {
    const std::size_t begin = line.find("\": \"") + 4;
    std::string text;
    for (std::size_t i = begin; i < line.size() && line[i] != '"'; ++i) text += line[i] == '\\' ? line[++i] : line[i];
    return text;
  };
  Compilation found;
  for (const std::string& line : lines_of(slurp(fs::path(IMPINGE_BINARY_DIR) / "compile_commands.json"))) {
    if (line.find("\"command\": ") != std::string::npos) found.command = value(line);
    if (line.find(wanted) == std::string::npos) continue;
    const std::size_t o = found.command.find(" -o ") + 4;
    found.output = found.command.substr(o, found.command.find(' ', o) - o);
    return found;
  }
  throw std::runtime_error("the build does not compile " + file);
}

Outcome shell(const std::string& command) { return program_run("/bin/sh", IMPINGE_BINARY_DIR, {"-c", command}); }

}  // namespace

std::vector<Recipe> recipes(const std::string& readme, const std::string& what) {
  std::vector<Recipe> found;
  std::string file;
  bool is_here = false, in_code = false;
  for (const std::string& line : lines_of(readme)) {
    if (in_code) {
      in_code = line != "```";
      if (in_code && is_here) found.back().code += line + "\n";
      continue;
    }
    if (line.starts_with("**") || line.starts_with("#")) is_here = line.starts_with("**" + what);
    if (!is_here) continue;
    file = last_path(line, file);
    in_code = line.starts_with("```");
    if (in_code) found.push_back({file, ""});
  }
  return found;
}

void ExtendedProgram::add(const Recipe& recipe) {
  const fs::path there = fs::path(IMPINGE_SOURCE_DIR) / recipe.file;
  if (!fs::exists(there)) {
    texts_[recipe.file] = recipe.code;
    ++new_files_;
    return;
  }
  std::string& text = texts_[recipe.file];
  if (text.empty()) text = slurp(there);
  for (const std::string& line : lines_of(recipe.code)) text = behind_its_like(text, line + "\n"), ++new_lines_;
}

Outcome ExtendedProgram::build() {
  std::string objects;
  for (const auto& [file, text] : texts_) {
    // a new file is compiled as the list of its folder is
    const bool is_new = !fs::exists(fs::path(IMPINGE_SOURCE_DIR) / file);
    const std::string like = is_new ? (fs::path(file).parent_path() / "all.cpp").string() : file;
    auto [command, output] = compilation_of(like);
    const fs::path source = folder_.write(file, text), object = folder_ / (file + ".o");
    replace(command, " -o " + output, " -o " + object.string());
    replace(command, " -c " + (fs::path(IMPINGE_SOURCE_DIR) / like).string(), " -c " + source.string());
    const Outcome compiled = shell(command);
    if (compiled.code != 0) return compiled;
    objects += " " + object.string();
  }
  // what comes before the libraries is taken, and theirs of the same name left
  const Outcome commands = shell("ninja -t commands impinge");
  if (commands.code != 0) return commands;
  std::string link = lines_of(commands.out).back();
  replace(link, " -o impinge ", " -o " + (folder_ / "impinge").string() + objects + " ");
  return shell(link);
}

Outcome ExtendedProgram::run(const fs::path& folder, const std::vector<std::string>& words) const {
  return program_run(folder_ / "impinge", folder, words);
}

}  // namespace impinge::test
