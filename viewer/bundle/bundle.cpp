#include "viewer/bundle/bundle.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "engine/core/archive.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "viewer/controller/script.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFolder = "impinge-bundle/", kHead = "impinge-bundle/bundle.toml";
constexpr int kForm = 1;
constexpr std::uint64_t kMostBytes = std::uint64_t{8} << 30;
constexpr std::string_view kHash = "hash = \"";  // of all that follows that line
constexpr std::size_t kHashLine = kHash.size() + 18;

[[noreturn]] void refuse_bundle(const std::string& file, const std::string& found) {
  throw InputError(
      fmt::format("{}: {}; a whole bundle is wanted; fetch it again, or write it again in the debugger", file, found));
}

std::string hash_of(std::string_view bytes) { return hex64(hash_bytes(bytes)); }

std::uint64_t read_hash(const TomlNode& node, const std::string& what) {
  const std::string& text = scene_text(node, what);
  if (text.size() != 16 || text.find_first_not_of("0123456789abcdef") != std::string::npos)
    refuse(node.place, fmt::format("{} is {}", what, toml_string(text)), "16 hex digits are wanted", "fetch it again");
  return std::stoull(text, nullptr, 16);
}

const TomlNode& need(const TomlNode& table, const char* key) {
  const TomlEntry* entry = table.find(key);
  if (entry == nullptr) refuse(table.place, fmt::format("no {}", key), "a bundle says it", "fetch it again");
  return entry->value;
}

int read_whole(const TomlNode& node, const std::string& what, Range range) {
  return static_cast<int>(scene_real(node, what, range));
}

/// Of the text of bundle.toml, whatever form it has.
TomlNode read_head(const std::string& file, std::string_view text) {
  if (text.size() < kHashLine || !text.starts_with(kHash) ||
      text.substr(kHash.size(), 16) != hash_of(text.substr(kHashLine)))
    refuse_bundle(file, "its bundle.toml is damaged");
  TomlNode root = parse_toml(file + " bundle.toml", std::string(text));
  if (const double form = scene_real(need(root, "form"), "form", {1, 1e9}); form != kForm)
    throw InputError(
        fmt::format("{}: is a bundle of form {:g}, by version {}; form {} is read; open it with that version", file,
                    form, scene_text(need(root, "version"), "version"), kForm));
  return root;
}

/// The scene of a bundle reads what is in the bundle, whatever somebody wrote into its run.toml.
void check_scene(const std::string& file, std::string_view text) {
  const TomlNode root = parse_toml(file + " run.toml", std::string(text));
  const auto said = [&](const char* table, const char* key) -> const TomlNode* {
    const TomlEntry* outer = root.find(table);
    const TomlEntry* inner = outer == nullptr ? nullptr : outer->value.find(key);
    return inner == nullptr ? nullptr : &inner->value;
  };
  const TomlNode *folder = said("run", "folder"), *start = said("run", "start"),
                 *outside = said("scene", "allow_outside_files");
  if (folder == nullptr || folder->string != "." || (start != nullptr && start->string != "start.bin") ||
      (outside != nullptr && outside->flag))
    refuse_bundle(file, "its scene asks for files outside of it");
}

}  // namespace

std::string format_bundle(const BundleHead& head, const std::map<std::string, std::string>& parts) {
  std::string text = fmt::format("form = {}\nversion = {}\nscene = {}\nframe = {}\n", kForm, toml_string(head.version),
                                 toml_string(head.scene), head.frame);
  if (head.stage >= 0) text += fmt::format("stage = {}\n", head.stage);
  text += fmt::format("state_hash = \"{}\"\n", hex64(head.state_hash));
  std::vector<TarPart> all(1);  // the first is written last
  for (const auto& [name, bytes] : parts) {
    text += fmt::format("\n[[part]]\nname = {}\nbytes = {}\nhash = \"{}\"\n", toml_string(name), bytes.size(),
                        hash_of(bytes));
    all.push_back({std::string(kFolder) + name, bytes});
  }
  text = fmt::format("{}{}\"\n{}", kHash, hash_of(text), text);
  all[0] = {std::string(kHead), text};
  return format_tar(all);
}

Bundle parse_bundle(const std::string& file, std::string_view bytes) {
  const std::string_view first = first_tar_part(bytes, kHead);
  if (first.empty()) refuse_bundle(file, bytes.empty() ? "is empty" : "is no bundle, or its beginning is damaged");
  const TomlNode root = read_head(file, first);
  check_keys(root, "bundle", {"hash", "form", "version", "scene", "frame", "stage", "state_hash", "part"});
  Bundle bundle;
  bundle.head.version = scene_text(need(root, "version"), "version");
  bundle.head.scene = scene_text(need(root, "scene"), "scene");
  bundle.head.frame = read_whole(need(root, "frame"), "frame", {0, 1e8});
  if (const TomlEntry* stage = root.find("stage")) bundle.head.stage = read_whole(stage->value, "stage", {0, 1e9});
  bundle.head.state_hash = read_hash(need(root, "state_hash"), "state_hash");

  std::map<std::string, std::string_view> there;
  for (const TarPart& part : parse_tar(file, bytes)) {
    if (part.name == kHead) continue;
    if (!part.name.starts_with(kFolder)) refuse_bundle(file, fmt::format("'{}' is none of its parts", part.name));
    there.emplace(part.name.substr(kFolder.size()), part.bytes);
  }
  const TomlNode& list = need(root, "part");
  for (const TomlNode& node : list.items) {
    const std::string& name = scene_text(need(node, "name"), "part.name");
    const auto it = there.find(name);
    if (it == there.end() || bundle.parts.contains(name))
      refuse_bundle(file, fmt::format("its part {} is not there", toml_string(name)));
    const double size = scene_real(need(node, "bytes"), "part.bytes", {0, 1e15});
    if (size != static_cast<double>(it->second.size()) ||
        read_hash(need(node, "hash"), "part.hash") != hash_bytes(it->second))
      refuse_bundle(file, fmt::format("its part {} is damaged", toml_string(name)));
    bundle.parts.insert(*it);
  }
  if (bundle.parts.size() != there.size()) refuse_bundle(file, "it holds more than its bundle.toml names");
  for (const char* name : {"run.toml", "stats.csv"})
    if (!there.contains(name)) refuse_bundle(file, fmt::format("it has no {}", name));
  return bundle;
}

bool is_bundle(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string head(kHead.size() + 1, 'x');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  return in.gcount() == static_cast<std::streamsize>(head.size()) && head == std::string(kHead) + '\0';
}

UnpackedBundle::UnpackedBundle(const fs::path& file) {
  const std::string bytes = read_file(file, kMostBytes);
  const Bundle bundle = parse_bundle(file.string(), bytes);
  check_scene(file.string(), bundle.parts.at("run.toml"));
  head_ = bundle.head;
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "impinge_bundle_XXXXXX").string();
  if (error || mkdtemp(name.data()) == nullptr)
    throw OutputError(
        fmt::format("{}: no temporary folder to open it in ({}); one that may be written to is wanted; set "
                    "TMPDIR",
                    file.string(), error ? error.message() : std::strerror(errno)));
  folder_ = name;
  try {
    for (const auto& [part, content] : bundle.parts) {
      // what another version kept of its states can't be read: the frames are made again
      if (part.starts_with("snapshots/") && head_.version != IMPINGE_VERSION) continue;
      make_folder((folder_ / part).parent_path());
      write_file(folder_ / part, content);
    }
  } catch (const OutputError& problem) {
    fs::remove_all(folder_, error);
    throw OutputError(
        fmt::format("{}: can't be opened in {} ({}); room for its {} bytes is wanted; free some or set "
                    "TMPDIR",
                    file.string(), folder_.parent_path().string(), problem.reason, bytes.size()));
  }
}

UnpackedBundle::~UnpackedBundle() {
  std::error_code error;
  fs::remove_all(folder_, error);
}

std::vector<std::string> UnpackedBundle::lines(const std::string& part) const {
  return is_file(folder_ / part) ? read_lines(folder_ / part) : std::vector<std::string>();
}

}  // namespace impinge
