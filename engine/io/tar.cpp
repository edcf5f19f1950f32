#include "engine/io/tar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "engine/core/error.hpp"

namespace impinge {

namespace {

constexpr std::size_t kBlock = 512, kMostName = 100, kMostFolder = 155;
constexpr std::uint64_t kMostBytes = (std::uint64_t{1} << 33) - 1;  // eleven octal digits

std::size_t in_blocks(std::size_t bytes) { return (bytes + kBlock - 1) / kBlock * kBlock; }

void put(std::string& block, std::size_t at, std::string_view text) {
  std::copy(text.begin(), text.end(), block.begin() + static_cast<std::ptrdiff_t>(at));
}

/// "" where the name doesn't fit.
std::string header(const std::string& name, std::uint64_t bytes) {
  std::size_t cut = 0;  // of a long name: what stands before the slash goes to a field of its own
  if (name.size() > kMostName) {
    cut = name.find('/', name.size() - kMostName - 1);
    if (cut == std::string::npos || cut > kMostFolder || cut == 0) return "";
  }
  std::string block(kBlock, '\0');
  put(block, 0, std::string_view(name).substr(cut == 0 ? 0 : cut + 1));
  put(block, 100, "0000644");
  put(block, 108, "0000000");
  put(block, 116, "0000000");
  put(block, 124, fmt::format("{:011o}", bytes));
  put(block, 136, "00000000000");
  put(block, 148, "        ");
  block[156] = '0';
  put(block, 257, "ustar");
  put(block, 263, "00");
  put(block, 345, std::string_view(name).substr(0, cut));
  unsigned sum = 0;
  for (const char c : block) sum += static_cast<unsigned char>(c);
  put(block, 148, fmt::format("{:06o}", sum));
  block[154] = '\0';
  return block;
}

std::string_view field(std::string_view block, std::size_t at, std::size_t size) {
  const std::string_view text = block.substr(at, size);
  return text.substr(0, text.find('\0'));
}

std::string name_in(std::string_view block) {
  const std::string_view folder = field(block, 345, kMostFolder), name = field(block, 0, kMostName);
  return folder.empty() ? std::string(name) : fmt::format("{}/{}", folder, name);
}

/// More than any file has, where it is no number.
std::uint64_t size_in(std::string_view block) {
  std::uint64_t size = 0;
  for (const char c : block.substr(124, 11)) {
    if (c < '0' || c > '7') return kMostBytes + 1;
    size = size * 8 + static_cast<std::uint64_t>(c - '0');
  }
  return size;
}

[[noreturn]] void refuse(const std::string& file, std::size_t at, const std::string& found) {
  throw InputError(
      fmt::format("{}: byte {}: {}; it is damaged or no file of impinge; fetch it again", file, at, found));
}

}  // namespace

bool is_tar_name(std::string_view name) {
  if (name.empty() || name.size() > kMostFolder + 1 + kMostName) return false;
  for (;;) {
    const std::string_view word = name.substr(0, name.find('/'));
    if (word.empty() || word == "." || word == ".." || word.find('\\') != std::string_view::npos) return false;
    if (std::any_of(word.begin(), word.end(), [](unsigned char c) { return c < ' ' || c == 127; })) return false;
    if (word.size() == name.size()) return true;
    name.remove_prefix(word.size() + 1);
  }
}

std::string format_tar(const std::vector<TarPart>& parts) {
  std::size_t size = 2 * kBlock;
  for (const TarPart& part : parts) size += kBlock + in_blocks(part.bytes.size());
  std::string out;
  out.reserve(size);
  for (const TarPart& part : parts) {
    const std::string head = part.bytes.size() <= kMostBytes && is_tar_name(part.name)
                                 ? header(part.name, part.bytes.size())
                                 : std::string();
    if (head.empty())
      throw InputError(
          fmt::format("{}: can't be put into one file with others; a name of at most {} characters and less than 8 GiB "
                      "are wanted; rename it or make it smaller",
                      part.name, kMostName));
    out += head;
    out += part.bytes;
    out.resize(in_blocks(out.size()), '\0');
  }
  out.append(2 * kBlock, '\0');
  return out;
}

std::vector<TarPart> parse_tar(const std::string& file, std::string_view bytes) {
  std::vector<TarPart> parts;
  std::set<std::string> names, folders;
  std::size_t at = 0;
  const auto left = [&] { return bytes.size() - at; };
  for (;;) {
    if (left() < kBlock) refuse(file, at, "it ends early");
    const std::string_view block = bytes.substr(at, kBlock);
    if (block.find_first_not_of('\0') == std::string_view::npos) break;
    const std::string name = name_in(block);
    const std::uint64_t size = size_in(block);
    if (!is_tar_name(name)) refuse(file, at, "a name that leads elsewhere, or none");
    if (size > kMostBytes || block != header(name, size))
      refuse(file, at, "what stands before a part is not as written");
    if (left() - kBlock < in_blocks(size)) refuse(file, at, fmt::format("'{}' ends early", name));
    if (!names.insert(name).second || folders.contains(name)) refuse(file, at, fmt::format("a second '{}'", name));
    for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
      folders.insert(name.substr(0, slash));
      if (names.contains(name.substr(0, slash))) refuse(file, at, fmt::format("'{}' lies in a file", name));
    }
    if (parts.size() == kMostTarParts) refuse(file, at, fmt::format("more than {} parts", kMostTarParts));
    parts.push_back({name, bytes.substr(at + kBlock, size)});
    const std::string_view filling = bytes.substr(at + kBlock + size, in_blocks(size) - size);
    at += kBlock + in_blocks(size);
    if (filling.find_first_not_of('\0') != std::string_view::npos) refuse(file, at, "something stands behind a part");
  }
  if (left() != 2 * kBlock || bytes.substr(at).find_first_not_of('\0') != std::string_view::npos)
    refuse(file, at, "its end is not as written");
  return parts;
}

std::string_view first_tar_part(std::string_view bytes, std::string_view name) {
  if (bytes.size() < kBlock || name_in(bytes) != name) return {};
  const std::uint64_t size = size_in(bytes);
  if (size > bytes.size() - kBlock) return {};
  return bytes.substr(kBlock, size);
}

}  // namespace impinge
