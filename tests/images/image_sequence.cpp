#include <catch2/catch.hpp>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "tests/support/pictures/pictures.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/png_sequence.hpp"
#include "viewer/present/video.hpp"

using namespace impinge;
using namespace impinge::test;
using Catch::Matchers::Contains;

namespace {

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// Sets PATH for its own life.
class SearchPath {
 public:
  explicit SearchPath(const std::string& path) : old_(std::getenv("PATH")) { setenv("PATH", path.c_str(), 1); }
  ~SearchPath() { setenv("PATH", old_.c_str(), 1); }

 private:
  std::string old_;
};

/// With a thread of its own, and in the caller's.
struct Threads {
  Threads() { set_thread_count(GENERATE(2, 1)); }
  ~Threads() { set_thread_count(0); }
};

}  // namespace

TEST_CASE("A sequence writes each frame under its number, in order, with its text") {
  const Threads threads;
  const TempFolder folder;
  const auto frames = folder.path() / "run" / "frames";
  {
    PngSequence sequence(frames);
    for (int k = 0; k < 40; ++k) sequence.add(3 * k, noise(50, 30, k), {{"impinge:frame", std::to_string(3 * k)}});
    sequence.finish();
    CHECK(files_in(frames) == 40);
    CHECK_NOTHROW(sequence.finish());
    CHECK_THROWS_AS(sequence.add(1, plain(2, 2), {}), InternalError);
  }
  CHECK(files_in(frames) == 40);
  for (int k = 0; k < 40; ++k) {
    const auto path = frames / fmt::format("{:06}.png", 3 * k);
    CHECK(read_png(path) == noise(50, 30, k));
    CHECK(read_png_text(path) == PngText{{"impinge:frame", std::to_string(3 * k)}});
  }
  CHECK(PngSequence::file_name(0) == "000000.png");
  CHECK(PngSequence::file_name(1234567) == "1234567.png");
}

TEST_CASE("A sequence that isn't finished still writes what it was given") {
  const Threads threads;
  const TempFolder folder;
  {
    PngSequence sequence(folder.path());
    for (int k = 0; k < 6; ++k) sequence.add(k, noise(400, 300, k), {});
  }
  REQUIRE(files_in(folder.path()) == 6);
  CHECK(read_png(folder / "000005.png") == noise(400, 300, 5));
  { const PngSequence unused(folder / "empty"); }
  CHECK(files_in(folder / "empty") == 0);
}

TEST_CASE("A frame written twice holds the later picture") {
  const Threads threads;
  const TempFolder folder;
  PngSequence sequence(folder.path());
  for (int k = 0; k < 20; ++k) sequence.add(7, noise(30, 30, k), {});
  sequence.finish();
  CHECK(files_in(folder.path()) == 1);
  CHECK(read_png(folder / "000007.png") == noise(30, 30, 19));
}

TEST_CASE("A frame that can't be written stops the sequence, and its caller learns of it") {
  const Threads threads;
  const TempFolder folder;
  std::filesystem::create_directory(folder / "000002.png");  // rename onto a folder fails
  std::string complaint;
  int added = 0;
  PngSequence sequence(folder.path());
  try {
    // a bounded queue: the failure must show before a hundred frames are handed over
    for (; added < 100; ++added) sequence.add(added, noise(20, 20, added), {});
  } catch (const InputError& error) {
    complaint = error.what();
  }
  CHECK(added < 100);
  CHECK(added >= 3);
  CHECK_THAT(complaint, Contains("000002.png"));
  CHECK_THROWS_AS(sequence.add(200, plain(2, 2), {}), InputError);
  CHECK_THROWS_WITH(sequence.finish(), Contains("000002.png"));
  CHECK(std::filesystem::exists(folder / "000001.png"));
  CHECK_FALSE(std::filesystem::exists(folder / "000003.png"));
  CHECK_FALSE(std::filesystem::exists(folder / "000002.png.tmp"));
}

TEST_CASE("A failure in the last frame shows when the sequence is finished") {
  const Threads threads;
  const TempFolder folder;
  std::filesystem::create_directory(folder / "000000.png");
  PngSequence sequence(folder.path());
  sequence.add(0, plain(5, 5), {});
  CHECK_THROWS_AS(sequence.finish(), InputError);
  // a failure of another kind arrives as what it is
  PngSequence other(folder / "other");
  other.add(0, Image(), {});
  CHECK_THROWS_AS(other.finish(), InternalError);
  // and no frames' folder can be made where a file stands
  folder.write("taken", "x");
  CHECK_THROWS_WITH(PngSequence(folder / "taken"), Contains((folder / "taken").string()));
  CHECK_THROWS_AS(PngSequence(folder / "taken" / "deeper"), InputError);
}

TEST_CASE("No film is made without ffmpeg, without frames or at no rate") {
  const TempFolder folder;
  CHECK_THROWS_AS(make_video(folder.path(), folder / "a.mp4", 30), InputError);
  CHECK_THROWS_AS(make_video(folder / "missing", folder / "a.mp4", 30), InputError);
  write_png(folder / "000000.png", plain(16, 16));
  for (const double rate : {0.0, -1.0, std::nan(""), HUGE_VAL})
    CHECK_THROWS_AS(make_video(folder.path(), folder / "a.mp4", rate), InputError);
  const SearchPath nothing_there(folder.path().string());
  CHECK_FALSE(make_video(folder.path(), folder / "a.mp4", 30));
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("A film appears complete or not at all") {
  const TempFolder folder;
  // odd sizes, a gap in the numbers, and a name full of what shells and ffmpeg's patterns treat specially
  const auto frames = folder.path() / "fra%d [mes] $HOME '";
  std::filesystem::create_directory(frames);
  for (const int k : {0, 1, 2, 5, 9, 10}) write_png(frames / PngSequence::file_name(k), noise(65, 33, k));
  const auto film = folder.path() / "film.mp4";
  if (!make_video(frames, film, 12.5)) {
    WARN("ffmpeg isn't installed: films are not tested");
    return;
  }
  const std::string bytes = slurp(film);
  CHECK(bytes.size() > 1000);
  CHECK(bytes.substr(4, 4) == "ftyp");
  // the sample table's count (stsz: 4 bytes of version and flags, sample size 0, count)
  const std::size_t table = bytes.find("stsz");
  REQUIRE(table != std::string::npos);
  CHECK(four_bytes(bytes, table + 12) == 6);

  CHECK_THROWS_WITH(make_video(frames, folder / "film.unknown", 30), Contains("film.unknown"));
  CHECK_THROWS_AS(make_video(frames, folder / "no folder" / "film.mp4", 30), InputError);
  const std::string whole = slurp(frames / "000001.png");
  std::ofstream(frames / "000001.png", std::ios::binary) << whole.substr(0, whole.size() / 2);
  CHECK_THROWS_AS(make_video(frames, film, 30), InputError);
  CHECK(slurp(film) == bytes);          // the older film is untouched
  CHECK(files_in(folder.path()) == 2);  // the frames and the film: no temporary file is left
}

TEST_CASE("A film for a message begins again and keeps its duration, a GIF its colours") {
  const TempFolder folder;
  const auto frames = folder.path() / "frames";
  std::filesystem::create_directory(frames);
  constexpr int kFrames = 12;
  for (int k = 0; k < kFrames; ++k) write_png(frames / PngSequence::file_name(k), noise(64, 48, k));
  const auto gif = folder.path() / "film.gif", webp = folder.path() / "film.webp";
  if (!make_video(frames, gif, 60)) {
    WARN("ffmpeg isn't installed: films are not tested");
    return;
  }
  // [GIF89a] a picture's graphic control extension: 21 F9 04, flags, the delay in hundredths of a second
  const std::string bytes = slurp(gif);
  CHECK(bytes.starts_with("GIF89a"));
  CHECK(bytes.find("NETSCAPE2.0") != std::string::npos);  // shown again and again
  int pictures = 0, hundredths = 0, shortest = 100;
  for (std::size_t at = bytes.find("\x21\xF9\x04"); at != std::string::npos; at = bytes.find("\x21\xF9\x04", at + 1)) {
    if (bytes[at + 7] != 0) continue;  // its end
    const int delay = static_cast<unsigned char>(bytes[at + 4]) + 256 * static_cast<unsigned char>(bytes[at + 5]);
    ++pictures, hundredths += delay, shortest = std::min(shortest, delay);
  }
  CHECK(pictures == kFrames / 2);
  CHECK(hundredths == Approx(100.0 * kFrames / 60.0).margin(2.0));
  CHECK(shortest >= 2);

  REQUIRE(make_video(frames, webp, 60));
  // RIFF chunks: ANIM (background, number of showings), ANMF each picture, with its duration in ms at 12
  const std::string riff = slurp(webp);
  CHECK(riff.substr(8, 4) == "WEBP");
  const auto little = [&](std::size_t at, int count) {
    int value = 0;
    for (int i = count; i-- > 0;)
      value = 256 * value + static_cast<unsigned char>(riff[at + static_cast<std::size_t>(i)]);
    return value;
  };
  int shown = 0, milliseconds = 0;
  for (std::size_t at = 12; at + 8 <= riff.size(); at += 8 + static_cast<std::size_t>(little(at + 4, 4) + 1) / 2 * 2) {
    const std::string chunk = riff.substr(at, 4);
    if (chunk == "ANIM") CHECK(little(at + 12, 2) == 0);
    if (chunk == "ANMF") ++shown, milliseconds += little(at + 8 + 12, 3);
  }
  CHECK(shown == kFrames);
  CHECK(milliseconds == Approx(1000.0 * kFrames / 60.0).margin(20.0));
}

TEST_CASE("A film of transparent pictures is laid over grey, a WebP stays transparent") {
  const TempFolder folder;
  const auto frames = folder.path() / "frames", back = folder.path() / "back";
  std::filesystem::create_directory(frames);
  std::filesystem::create_directory(back);
  Image image = plain(64, 48, {255, 200, 40});
  image.alpha.assign(64u * 48u, 255);
  // nothing, then half of it, then all
  for (std::size_t i = 0; i < image.alpha.size(); ++i)
    image.alpha[i] = static_cast<std::uint8_t>(i % 64 < 16 ? 0 : i % 64 < 32 ? 128 : 255);
  for (int k = 0; k < 3; ++k) write_png(frames / PngSequence::file_name(k), image);
  const auto film = folder.path() / "film.mp4", webp = folder.path() / "film.webp";
  if (!make_video(frames, film, 25)) {
    WARN("ffmpeg isn't installed: films are not tested");
    return;
  }
  REQUIRE(std::system(("ffmpeg -nostdin -loglevel error -i '" + film.string() + "' '" + back.string() + "/%06d.png'")
                          .c_str()) == 0);
  const Image shown = read_png(back / "000002.png");
  for (int c = 0; c < 3; ++c) {
    CHECK(std::abs(shown.pixel(8, 24)[c] - kBehind[c]) < 8);  // films have coarser colours
    CHECK(std::abs(shown.pixel(56, 24)[c] - image.pixel(56, 24)[c]) < 8);
  }
  REQUIRE(make_video(frames, webp, 25));
  const std::string riff = slurp(webp);
  REQUIRE(riff.substr(12, 4) == "VP8X");
  CHECK((riff[20] & 0x10) != 0);  // pictures with alpha
}
