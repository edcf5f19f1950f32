#include "viewer/controller/run_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "engine/core/interrupt.hpp"
#include "engine/io/file.hpp"
#include "engine/io/folder_lock.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/toml.hpp"

namespace impinge {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostOfToml = std::uint64_t{1} << 30;
constexpr std::string_view kRecord[] = {"run.toml", "commands.log", "stats.csv", "contacts.csv", "ledger.csv", "done"};
// what impinge export writes
constexpr std::string_view kExported[] = {".ply", ".obj", ".mtl", ".gltf", ".glb", ".bin",
                                          ".vtu", ".vtp", ".pvd", ".usda", ".csv", ".json"};

template <std::size_t N>
bool is_among(const std::string_view (&names)[N], std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

bool is_six_digits(std::string_view text) {
  return text.size() == 6 && text.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_numbered(const fs::path& name, std::string_view ending) {
  return name.extension() == ending && is_six_digits(name.stem().string());
}

/// By the path from the run's folder on.
RunPart part_of(const fs::path& from_run) {
  std::vector<std::string> way;
  for (const fs::path& step : from_run) way.push_back(step.string());
  const fs::path name = from_run.filename();
  const std::string& top = way.front();
  if (way.size() == 1) {
    if (is_among(kRecord, top) || top == FolderLock::kName) return RunPart::record;
    if (top == "contact_sheet.png") return RunPart::pictures;
    return is_temporary_name(top) ? RunPart::record : RunPart::other;
  }
  if (top == "export" && is_among(kExported, name.extension().string())) return RunPart::exports;
  if (way.size() == 3 && top == "surfaces" && is_six_digits(way[1]) &&
      (name.extension() == ".ply" || is_temporary_name(name.string())))
    return RunPart::exports;
  if (way.size() != 2) return RunPart::other;
  const bool is_left_over = is_temporary_name(name.string());
  if ((top == "frames" || top == "ids") && (is_numbered(name, ".png") || is_left_over)) return RunPart::pictures;
  if (top == "snapshots" && (is_numbered(name, ".bin") || is_left_over)) return RunPart::snapshots;
  if (top == "frozen" && (is_numbered(name, ".step") || is_left_over)) return RunPart::record;
  return RunPart::other;
}

enum class Kind { file, folder, other };

/// Of the name itself: a link is a link.
Kind kind_of(const fs::path& path) {
  std::error_code error;
  switch (fs::symlink_status(path, error).type()) {
    case fs::file_type::regular:
      return Kind::file;
    case fs::file_type::directory:
      return Kind::folder;
    default:
      return Kind::other;
  }
}

void add_files(const fs::path& run, const fs::path& folder, std::vector<RunFile>& files) {
  for (const std::string& name : names_in(folder)) {
    check_interrupt();
    const fs::path path = folder / name;
    const Kind kind = kind_of(path);
    if (kind == Kind::folder) {
      add_files(run, path, files);
      continue;
    }
    RunFile file{path, RunPart::other, 0};
    if (kind == Kind::file) {
      std::error_code error;
      file.bytes = fs::file_size(path, error);
      if (error) file.bytes = 0;
      file.part = part_of(path.lexically_relative(run));
    }
    files.push_back(std::move(file));
  }
}

void add_runs(const fs::path& folder, std::vector<fs::path>& runs) {
  check_interrupt();
  if (is_run_folder(folder)) return runs.push_back(folder);
  for (const std::string& name : names_in(folder))
    if (kind_of(folder / name) == Kind::folder) add_runs(folder / name, runs);
}

}  // namespace

bool is_run_folder(const fs::path& folder) {
  const fs::path file = folder / "run.toml";
  if (kind_of(file) != Kind::file) return false;
  try {
    return parse_toml(file.string(), read_file(file, kMostOfToml)).find("run") != nullptr;
  } catch (const InputError&) {
    return false;
  }
}

std::vector<RunFile> files_of_run(const fs::path& folder) {
  std::vector<RunFile> files;
  add_files(folder, folder, files);
  return files;
}

std::vector<fs::path> runs_below(const fs::path& folder) {
  std::vector<fs::path> runs;
  add_runs(folder, runs);
  return runs;
}

void remove_run_file(const fs::path& run, const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error)
    throw OutputError(
        fmt::format("{}: can't be removed ({}); a folder that may be written to is wanted; check its "
                    "permissions",
                    file.string(), error.message()));
  for (fs::path folder = file.parent_path(); folder != run && folder.has_relative_path();
       folder = folder.parent_path()) {
    fs::remove(folder, error);  // refused unless it is empty
    if (error) return;
  }
}

void empty_run_folder(const fs::path& folder) {
  if (is_there(folder / "done")) remove_run_file(folder, folder / "done");
  for (const RunFile& file : files_of_run(folder)) {
    const bool is_mark = file.path == folder / "run.toml" || file.path == folder / FolderLock::kName;
    if (file.part != RunPart::other && !is_mark) remove_run_file(folder, file.path);
  }
}

}  // namespace impinge
