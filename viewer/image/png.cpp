#include "viewer/image/png.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <memory>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "viewer/image/png_pixels.hpp"

namespace impinge {

namespace {

using namespace std::string_view_literals;

constexpr auto kSignature = "\x89PNG\r\n\x1a\n"sv;
constexpr std::size_t kHeaderEnd = 8 + 12 + 13;  // the signature and the chunk IHDR, which comes first
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 28;
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 26;
constexpr std::uint64_t kDeflateMost = 1032;  // bytes that one packed byte can come to: four matches of 258

struct Chunk {
  std::string_view type, data;
};

std::uint32_t big_endian(std::string_view four) {
  std::uint32_t value = 0;
  for (const char c : four) value = value << 8 | static_cast<std::uint8_t>(c);
  return value;
}

void append_big_endian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift);
}

std::string text_chunk(const std::string& keyword, const std::string& text) {
  IMPINGE_ASSERT(!keyword.empty() && keyword.size() <= 79 && text.find('\0') == std::string::npos);
  IMPINGE_ASSERT(std::all_of(keyword.begin(), keyword.end(), [](char c) { return c >= ' ' && c <= '~'; }));
  const std::string body = "tEXt" + keyword + '\0' + text;
  std::string chunk;
  append_big_endian(chunk, static_cast<std::uint32_t>(body.size() - 4));
  chunk += body;
  append_big_endian(chunk, libdeflate_crc32(0, body.data(), body.size()));
  return chunk;
}

[[noreturn]] void refuse(const std::string& name, const std::string& found) {
  throw InputError(name + ": " + found + "; a whole PNG picture is wanted; write it again or name another");
}

/// Every chunk up to IEND, checksums tested. `bytes` must outlive the answer.
std::vector<Chunk> split_chunks(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, kSignature.size()) != kSignature) refuse(name, "is not a PNG file");
  std::vector<Chunk> chunks;
  for (std::size_t at = kSignature.size();;) {
    if (bytes.size() - at < 12) refuse(name, "the PNG file is cut short");
    const std::size_t size = big_endian(bytes.substr(at, 4));
    if (bytes.size() - at - 12 < size) refuse(name, "the PNG file is cut short or damaged");
    const std::string_view typed = bytes.substr(at + 4, 4 + size);
    if (libdeflate_crc32(0, typed.data(), typed.size()) != big_endian(bytes.substr(at + 8 + size, 4)))
      refuse(name, fmt::format("the PNG file is damaged: wrong checksum in the chunk at byte {}", at));
    chunks.push_back({typed.substr(0, 4), typed.substr(4)});
    if (chunks.size() == 1 && (chunks[0].type != "IHDR" || size != 13)) refuse(name, "the PNG file has no header");
    if (chunks.back().type == "IEND") return chunks;
    at += 12 + size;
  }
}

/// Bytes of the rows as they are packed, at most: each has its filter before it, and interlacing makes more rows of them.
std::uint64_t most_packed(std::string_view header) {
  const std::uint64_t width = big_endian(header.substr(0, 4)), height = big_endian(header.substr(4, 4));
  const std::uint64_t depth = std::min<std::uint64_t>(static_cast<std::uint8_t>(header[8]), 16);
  const auto kind = static_cast<std::uint8_t>(header[9]);
  const std::uint64_t channels = kind == 2 ? 3 : kind == 4 ? 2 : kind == 6 ? 4 : 1;
  const std::uint64_t rows = height * (1 + (width * channels * depth + 7) / 8);
  return header[12] == 0 ? rows : 2 * rows + 64;
}

/// A few bytes can be packed so that they unpack to thousands of times as many, which stb would all take.
void check_unpacked(const std::vector<Chunk>& chunks, const std::string& name) {
  std::string packed;
  for (const Chunk& chunk : chunks)
    if (chunk.type == "IDAT") packed += chunk.data;
  const std::uint64_t most = most_packed(chunks.front().data);
  // no more than can come of what is there: a header alone takes no memory
  std::string rows(std::min<std::uint64_t>(most, kDeflateMost * packed.size()), '\0');
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> unpacker(
      libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  std::size_t size = 0;
  if (libdeflate_zlib_decompress(unpacker.get(), packed.data(), packed.size(), rows.data(), rows.size(), &size) ==
      LIBDEFLATE_INSUFFICIENT_SPACE)
    refuse(name, fmt::format("the PNG file unpacks to more than the {} bytes of its pixels", most));
}

Image opaque(Image image) {
  for (std::size_t i = 0; i < image.rgb.size() && !image.alpha.empty(); ++i) {
    const int a = image.alpha[i / 3];
    image.rgb[i] = static_cast<std::uint8_t>((a * image.rgb[i] + (255 - a) * kBehind[i % 3] + 127) / 255);
  }
  image.alpha.clear();
  return image;
}

}  // namespace

std::string encode_png(const Image& image, const PngText& text) {
  std::string file = encode_png_pixels(image);
  std::string chunks;
  for (const auto& [keyword, value] : text) chunks += text_chunk(keyword, value);
  file.insert(kHeaderEnd, chunks);
  return file;
}

Image decode_png(std::string_view bytes, const std::string& name) {
  const std::vector<Chunk> chunks = split_chunks(bytes, name);
  const std::string_view header = chunks.front().data;
  const std::uint64_t width = big_endian(header.substr(0, 4)), height = big_endian(header.substr(4, 4));
  if (width == 0 || height == 0) refuse(name, "the PNG file has no pixels");
  if (width > kMaxPixels / height)
    throw InputError(fmt::format("{}: has {} x {} pixels; at most {} in all are taken; make it smaller", name, width,
                                 height, kMaxPixels));
  check_unpacked(chunks, name);
  Image image;
  std::string reason;
  if (!decode_png_pixels(bytes, image, reason)) refuse(name, "the PNG file is damaged (" + reason + ")");
  return opaque(std::move(image));
}

void write_png(const std::filesystem::path& path, const Image& image, const PngText& text) {
  write_file(path, encode_png(image, text));
}

Image read_png(const std::filesystem::path& path) { return decode_png(read_file(path, kMaxBytes), path.string()); }

PngText read_png_text(const std::filesystem::path& path) {
  const std::string bytes = read_file(path, kMaxBytes);
  PngText text;
  for (const Chunk& chunk : split_chunks(bytes, path.string())) {
    const std::size_t end = chunk.data.find('\0');
    if (chunk.type == "tEXt" && end != std::string_view::npos)
      text.emplace_back(chunk.data.substr(0, end), chunk.data.substr(end + 1));
  }
  return text;
}

}  // namespace impinge
