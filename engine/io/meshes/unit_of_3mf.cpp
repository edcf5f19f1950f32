// The unit of a 3MF file, which assimp leaves out: an attribute of <model>, in the archive's part with the ending .model.
#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <memory>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/meshes/mesh_readers.hpp"

namespace impinge {
namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{4} << 30;
constexpr std::uint64_t kMostPacked = 1032;                 // bytes that a packed one can stand for
constexpr std::size_t kEnd = 22, kEntry = 46, kLocal = 30;  // bytes of an archive's records, without what follows them

constexpr std::pair<std::string_view, double> kUnitsOf3mf[] = {
    {"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2}, {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1.0},
};

/// The value of `name="..."` in a tag's text; nothing where it isn't there.
std::optional<std::string> attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    std::size_t next = at + name.size();
    const auto skip = [&] { next = std::min(tag.find_first_not_of(" \t\r\n", next), tag.size()); };
    skip();
    if (at == 0 || std::string_view(" \t\r\n").find(tag[at - 1]) == std::string_view::npos || next >= tag.size() ||
        tag[next] != '=')
      continue;
    ++next;
    skip();
    if (next >= tag.size() || (tag[next] != '"' && tag[next] != '\'')) return std::nullopt;
    const std::size_t end = tag.find(tag[next], next + 1);
    if (end == std::string_view::npos) return std::nullopt;
    return std::string(tag.substr(next + 1, end - next - 1));
  }
  return std::nullopt;
}

/// The text of <model ...>, whatever prefix it has; "" where there is none.
std::string_view model_tag(std::string_view text) {
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    if (text.substr(at).starts_with("<!--")) {
      at = text.find("-->", at);
      if (at == std::string_view::npos) return "";
      continue;
    }
    const std::size_t end = text.find('>', at);
    if (end == std::string_view::npos) return "";
    const std::string_view tag = text.substr(at + 1, end - at - 1);
    std::string_view word = tag.substr(0, tag.find_first_of(" \t\r\n"));
    if (const std::size_t colon = word.find(':'); colon != std::string_view::npos) word.remove_prefix(colon + 1);
    if (word == "model") return tag;
  }
  return "";
}

std::string_view part_of(std::string_view bytes, std::size_t at, std::size_t size) {
  if (at > bytes.size() || bytes.size() - at < size) throw InputError("its archive ends early");
  return bytes.substr(at, size);
}

std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  const std::string_view part = part_of(bytes, at, size);
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(part[i]);
  return value;
}

/// A file of the archive, by its entry in the list of files.
std::string unpacked(std::string_view archive, std::size_t entry) {
  const auto method = number_at(archive, entry + 10, 2), packed = number_at(archive, entry + 20, 4),
             size = number_at(archive, entry + 24, 4), local = number_at(archive, entry + 42, 4);
  const std::size_t begin = local + kLocal + number_at(archive, local + 26, 2) + number_at(archive, local + 28, 2);
  const std::string_view data = part_of(archive, begin, packed);
  if (method == 0) return std::string(data);
  if (method != 8) throw InputError(fmt::format("its archive is packed by method {}", method));
  // what can't be true must not cost the memory that it asks for
  if (size > kMostPacked * packed)
    throw InputError(fmt::format("its archive says {} bytes where {} are", size, packed));
  std::string text(size, '\0');
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflate(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (libdeflate_deflate_decompress(inflate.get(), data.data(), data.size(), text.data(), text.size(), nullptr) !=
      LIBDEFLATE_SUCCESS)
    throw InputError("its archive can't be unpacked");
  return text;
}

/// The first file of a zip archive whose name has that ending; "" where there is none.
std::string file_in_zip(std::string_view archive, std::string_view name_ending) {
  const std::size_t end = archive.rfind("PK\5\6");
  if (end == std::string_view::npos || archive.size() - end < kEnd) throw InputError("it is no archive");
  const auto count = number_at(archive, end + 10, 2);
  std::size_t entry = number_at(archive, end + 16, 4);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (part_of(archive, entry, kEntry).substr(0, 4) != "PK\1\2") throw InputError("its archive is damaged");
    const std::size_t name = number_at(archive, entry + 28, 2);
    if (part_of(archive, entry + kEntry, name).ends_with(name_ending)) return unpacked(archive, entry);
    entry += kEntry + name + number_at(archive, entry + 30, 2) + number_at(archive, entry + 32, 2);
  }
  return "";
}

}  // namespace

double metres_of_3mf(const std::string& path) {
  const std::string model = file_in_zip(read_file(path, kLargestFile), ".model");
  // which the format takes where nothing is said
  const std::string unit = attribute(model_tag(model), "unit").value_or("millimeter");
  for (const auto& [name, metres] : kUnitsOf3mf)
    if (name == unit) return metres;
  throw InputError(fmt::format("its unit is '{}'", unit.substr(0, 40)));
}

}  // namespace impinge
