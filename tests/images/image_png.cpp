#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <string>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "tests/support/pictures/pictures.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;
using Catch::Matchers::Contains;

namespace {

std::string complaint_of(const std::string& bytes) {
  try {
    decode_png(bytes, "x.png");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// While it lives no file of this process grows beyond some bytes: a write fails like one onto a full disk.
class FullDisk {
 public:
  FullDisk() : before_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit small{16, limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, before_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit limit_{};
  void (*before_)(int);
};

}  // namespace

TEST_CASE("A picture comes back from its PNG file pixel by pixel, and its text word by word") {
  const TempFolder folder;
  const PngText text = {{"impinge:scene", "two spheres"},
                        {"impinge:frame", "17"},
                        {"impinge:commands", "set gravity [0, -9.81, 0]\nat 3 push ball [1, 0, 0]\n"},
                        {"impinge:state_hash", "00ff00ff00ff00ff"},
                        {"impinge:renderer", ""}};
  int seed = 1;
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {2, 3}, {1, 257}, {641, 1}, {127, 61}, {1280, 720}}) {
    INFO(width << " x " << height);
    const Image image = noise(width, height, static_cast<std::uint64_t>(seed++));
    const auto path = folder.path() / "picture.png";
    write_png(path, image, text);
    CHECK(read_png(path) == image);
    CHECK(read_png_text(path) == text);
    write_png(path, image);
    CHECK(read_png(path) == image);
    CHECK(read_png_text(path).empty());
    CHECK_FALSE(std::filesystem::exists(path.string() + ".tmp"));
  }
}

TEST_CASE("A PNG file has the signature, its text between header and pixels, and true checksums") {
  Image image = plain(640, 360);
  draw_disc(image, 200, 150, 60);
  const std::string file = encode_png(image, {{"impinge:frame", "3"}, {"b", "c"}});
  CHECK(file.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  const auto chunks = png_chunks(file);
  std::string types;
  for (const PngChunk& chunk : chunks) {
    types += chunk.type + ' ';
    CHECK(chunk.crc_holds);
  }
  CHECK(types == "IHDR tEXt tEXt IDAT IEND ");
  CHECK(four_bytes(chunks.at(0).data, 0) == 640);
  CHECK(four_bytes(chunks.at(0).data, 4) == 360);
  CHECK(chunks.at(0).data.substr(8) == std::string("\x08\x02\x00\x00\x00", 5));  // 8-bit RGB, not interlaced
  CHECK(chunks.at(1).data == std::string("impinge:frame\0"
                                         "3",
                                         15));
  // the check value of CRC-32 itself, so that plain_crc32 isn't taken on trust
  CHECK(plain_crc32("123456789") == 0xCBF43926u);
  CHECK(encode_png(image, {{"impinge:frame", "3"}, {"b", "c"}}) == file);
}

TEST_CASE("The PNG decoder agrees with pixels computed by hand") {
  // 2 x 2, filter bytes 0 and 2 (up), one stored deflate block: no compressor of ours had a part in it
  const std::string raw(
      "\x00\x0A\x14\x1E\xFF\x00\x80"
      "\x02\x01\x02\x03\x02\x00\x80",
      14);
  std::uint32_t a = 1, b = 0;  // Adler-32
  for (const char c : raw) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto be = [](std::uint32_t v) {
    return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
                       static_cast<char>(v)};
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    return be(static_cast<std::uint32_t>(data.size())) + type + data + be(plain_crc32(type + data));
  };
  std::string zlib("\x78\x01\x01\x0E\x00\xF1\xFF", 7);
  zlib += raw;
  zlib += be(b << 16 | a);
  const std::string file = "\x89PNG\r\n\x1a\n" + chunk("IHDR", be(2) + be(2) + std::string("\x08\x02\0\0\0", 5)) +
                           chunk("IDAT", zlib) + chunk("IEND", "");
  const Image image = decode_png(file, "by hand");
  REQUIRE(image.width == 2);
  REQUIRE(image.height == 2);
  CHECK(image.rgb == std::vector<std::uint8_t>{10, 20, 30, 255, 0, 128, 11, 22, 33, 1, 0, 0});

  // a header that promises far more than is there is refused before any memory is asked for
  const std::string huge = "\x89PNG\r\n\x1a\n" +
                           chunk("IHDR", be(60000) + be(60000) + std::string("\x08\x02\0\0\0", 5)) +
                           chunk("IDAT", zlib) + chunk("IEND", "");
  CHECK_THAT(complaint_of(huge), Contains("x.png: has 60000 x 60000 pixels"));
  // so is one whose pixels are few and unpack to many
  const std::string large = encode_png(plain(3000, 2000));
  const std::size_t at = large.find("IDAT");
  const std::string packed = large.substr(at + 4, large.find("IEND") - 8 - (at + 4));
  const std::string bomb = "\x89PNG\r\n\x1a\n" + chunk("IHDR", be(16) + be(16) + std::string("\x08\x02\0\0\0", 5)) +
                           chunk("IDAT", packed) + chunk("IEND", "");
  CHECK_THAT(complaint_of(bomb), Contains("x.png: the PNG file unpacks to more than the 784 bytes of its pixels"));
  // and a header of many pixels before next to nothing takes no memory for them
  const auto peak = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;  // KB
  };
  const std::string hollow = "\x89PNG\r\n\x1a\n" +
                             chunk("IHDR", be(8192) + be(8192) + std::string("\x10\x06\0\0\0", 5)) +
                             chunk("IDAT", zlib) + chunk("IEND", "");
  const long before = peak();
  CHECK_FALSE(complaint_of(hollow).empty());
  CHECK(peak() - before < 100'000);
  const std::string none =
      "\x89PNG\r\n\x1a\n" + chunk("IHDR", be(0) + be(2) + std::string("\x08\x02\0\0\0", 5)) + chunk("IEND", "");
  CHECK_THAT(complaint_of(none), Contains("has no pixels"));
  const std::string headless = "\x89PNG\r\n\x1a\n" + chunk("IDAT", zlib) + chunk("IEND", "");
  CHECK_THAT(complaint_of(headless), Contains("has no header"));
}

TEST_CASE("Every cut and every changed byte of a PNG file is noticed") {
  const std::string file = encode_png(noise(9, 7, 5), {{"impinge:frame", "12"}});
  REQUIRE(complaint_of(file).empty());
  for (std::size_t size = 0; size < file.size(); ++size) {
    INFO("cut to " << size << " of " << file.size());
    CHECK_THAT(complaint_of(file.substr(0, size)), Contains("x.png: "));
  }
  for (std::size_t at = 0; at < file.size(); ++at)
    for (const int change : {0x01, 0x80}) {
      std::string damaged = file;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      INFO("byte " << at << " changed by " << change);
      CHECK_THAT(complaint_of(damaged), Contains("x.png: "));
    }
  CHECK_THAT(complaint_of("GIF89a............"), Contains("is not a PNG file"));
}

TEST_CASE("What can't be read or written as PNG is refused by name") {
  const TempFolder folder;
  const auto missing = folder.path() / "missing.png", nowhere = folder.path() / "no folder" / "a.png";
  CHECK_THROWS_WITH(read_png(missing), Contains(missing.string()));
  CHECK_THROWS_AS(read_png(missing), InputError);
  CHECK_THROWS_AS(read_png(folder.path()), InputError);
  CHECK_THROWS_AS(read_png_text(missing), InputError);
  CHECK_THROWS_AS(write_png(nowhere, plain(4, 4)), InputError);
  CHECK_THROWS_WITH(write_png(nowhere, plain(4, 4)), Contains(nowhere.string()));
  // a failed write leaves the older picture as it was
  const auto kept = folder.path() / "kept.png";
  write_png(kept, noise(8, 8, 1));
  {
    const FullDisk disk;
    CHECK_THROWS_WITH(write_png(kept, noise(8, 8, 2)), Contains(kept.string()) && Contains("File too large"));
    const auto full = folder.path() / "full.png";
    CHECK_THROWS_WITH(write_png(full, plain(4, 4)), Contains(full.string()));
    CHECK_FALSE(std::filesystem::exists(full));
  }
  CHECK(read_png(kept) == noise(8, 8, 1));
  CHECK_THROWS_AS(encode_png(Image()), InternalError);
  CHECK_THROWS_AS(encode_png(plain(1, 1), {{"", "x"}}), InternalError);
  CHECK_THROWS_AS(encode_png(plain(1, 1), {{std::string(80, 'k'), "x"}}), InternalError);
  CHECK_THROWS_AS(encode_png(plain(1, 1), {{"k", std::string("a\0b", 3)}}), InternalError);
}
