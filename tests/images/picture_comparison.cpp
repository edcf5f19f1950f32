// Planted changes are told apart and named; what other renderers do is not reported.
#include <catch2/catch.hpp>

#include <algorithm>
#include <fstream>

#include "engine/core/error.hpp"
#include "tests/support/pictures/pictures.hpp"
#include "tests/support/pictures/view_scenes.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/compare/picture_comparison.hpp"
#include "viewer/present/frame_painter.hpp"
#include "viewer/report/html.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

struct Facts {
  std::string frame = "7", state = "0123456789abcdef", renderer = "llvmpipe (LLVM 15.0.6, 256 bits) 22.3.6";
};

StepRecord with_identities(StepRecord record) {
  for (std::size_t i = 0; i < record.contacts.size(); ++i) record.contacts[i].pair_id = 1000 + i;
  return record;
}

const std::vector<std::string> kLayers = {"meshes", "contacts", "normals"};

/// A picture of the record with its ids beside it, as a run leaves them.
struct Painted {
  Image image;
  IdImage ids;
  Painted(const StepRecord& record, const std::vector<std::string>& layers = kLayers) {
    FramePainter painter(640, 360);
    painter.paint(record, settings_with(layers), image, ids);
    keep_visible_objects(ids);
  }
  fs::path write(const TempFolder& folder, const std::string& side, const Facts& facts = {}) const {
    const fs::path file = folder / (side + "/frames/000007.png");
    fs::create_directories(file.parent_path());
    fs::create_directories(id_picture_of(file).parent_path());
    write_png(file, image,
              {{"impinge:scene", "s.toml"},
               {"impinge:frame", facts.frame},
               {"impinge:state_hash", facts.state},
               {"impinge:renderer", facts.renderer}});
    write_png(id_picture_of(file), id_picture(ids), id_text(ids));
    return file;
  }
};

bool says(const PictureComparison& c, const std::string& words) {
  return std::any_of(c.details.begin(), c.details.end(),
                     [&](const std::string& line) { return line.find(words) != std::string::npos; });
}

PictureComparison compared(const Painted& a, const Painted& b, const Facts& facts_a = {}, const Facts& facts_b = {}) {
  const TempFolder folder;
  const PictureComparison c =
      compare_pictures("000007.png", a.write(folder, "a", facts_a), b.write(folder, "b", facts_b), {});
  UNSCOPED_INFO(c.headline);
  for (const std::string& line : c.details) UNSCOPED_INFO(line);
  return c;
}

}  // namespace

TEST_CASE("one contact's arrow that is missing is named with its two bodies") {
  const StepRecord whole = with_identities(sample_record());
  StepRecord less = whole;
  less.contacts.pop_back();  // between stone and wheel
  const PictureComparison c = compared(whole, less);
  CHECK(c.verdict == PictureComparison::different);
  CHECK(c.cause == ChangeCause::drawing);
  CHECK(says(c, "only the drawing changed"));
  CHECK(c.kind.kind == ChangeKind::missing);
  CHECK(says(c, "normals: 1 arrow between stone and wheel missing (of 1 in A"));
  CHECK(says(c, "contacts: 1 point between stone and wheel missing (of 1 in A"));
  CHECK_FALSE(says(c, "meshes"));
  CHECK_FALSE(says(c, "slab"));
  // one of two between the same bodies
  StepRecord other = whole;
  other.contacts.erase(other.contacts.begin() + 1);
  const PictureComparison d = compared(other, whole);
  CHECK(d.kind.kind == ChangeKind::added);
  CHECK(says(d, "contacts: 1 point between slab and crate new (of 1 in A"));
  CHECK_FALSE(says(d, "wheel"));
}

TEST_CASE("a picture moved by whole pixels says which way") {
  const Painted a(with_identities(sample_record()));
  for (const auto& [dx, dy, words] : {std::tuple{1, 0, "moved by 1 pixel to the right"},
                                      {0, -1, "moved by 1 pixel up"},
                                      {-2, 3, "moved by 2 pixels to the left and 3 pixels down"}}) {
    Painted b = a;
    for (int y = 0; y < 360; ++y)
      for (int x = 0; x < 640; ++x)
        std::copy_n(a.image.pixel(std::clamp(x - dx, 0, 639), std::clamp(y - dy, 0, 359)), 3, b.image.pixel(x, y));
    const PictureComparison c = compared(a, b);
    CHECK(c.verdict == PictureComparison::different);
    CHECK(c.kind.kind == ChangeKind::moved);
    CHECK(c.kind.dx == dx);
    CHECK(c.kind.dy == dy);
    CHECK(says(c, words));
  }
}

TEST_CASE("a body in another colour is named, and nothing is said to be missing") {
  const Painted a(with_identities(sample_record()));
  Painted b = a;
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 640; ++x)
      if (const IdObject* o = a.ids.object_at(x, y); o != nullptr && o->mark == "surface" && o->body == "ball")
        std::swap(b.image.pixel(x, y)[0], b.image.pixel(x, y)[2]);
  const PictureComparison c = compared(a, b);
  CHECK(c.verdict == PictureComparison::different);
  CHECK(c.kind.kind == ChangeKind::recolored);
  REQUIRE(c.objects.size() == 1);
  CHECK(says(c, "meshes: ball changed"));
}

TEST_CASE("another frame, another state and another renderer are told apart by what the pictures say") {
  const Painted a(with_identities(sample_record())), b(with_identities(other_record()));
  CHECK(says(compared(a, b, {}, {"8", "fedcba9876543210"}), "another frame (A shows frame 7, B frame 8)"));
  const PictureComparison state = compared(a, b, {}, {"7", "fedcba9876543210"});
  CHECK(state.cause == ChangeCause::state);
  CHECK(says(state, "the state changed (hash 0123456789abcdef in A, fedcba9876543210 in B)"));
  CHECK(says(state, "meshes: ball changed"));
  CHECK(state.kind.kind == ChangeKind::other);
  const PictureComparison renderer =
      compared(a, b, {}, {"7", "0123456789abcdef", "llvmpipe (LLVM 19.1.7, 256 bits) 25.0.7"});
  CHECK(renderer.cause == ChangeCause::renderer);
  CHECK(says(renderer, "only the renderer changed"));
}

TEST_CASE("what another renderer does to the last bits is no difference") {
  const Painted a(with_identities(sample_record()));
  Painted b = a;
  Random random(5);
  for (auto& value : b.image.rgb) value = static_cast<std::uint8_t>(std::clamp(value + random.below(7) - 3, 0, 255));
  for (int k = 0; k < 8; ++k) b.image.pixel(40 + 70 * k, 300 - 30 * k)[1] ^= 0x40;
  const PictureComparison c = compared(a, b, {}, {"7", "0123456789abcdef", "llvmpipe (LLVM 15.0.6, 128 bits) 22.3.6"});
  CHECK(c.verdict == PictureComparison::same);
  CHECK(c.headline.empty());
  CHECK(c.details.empty());
}

TEST_CASE("renderers have short keys, and alternates stand beside their baseline") {
  CHECK(renderer_key("llvmpipe (LLVM 15.0.6, 256 bits) 22.3.6") == "llvmpipe-22.3.6-256");
  CHECK(renderer_key("llvmpipe (LLVM 15.0.6, 128 bits) 22.3.6") == "llvmpipe-22.3.6-128");
  CHECK(renderer_key("softpipe 25.0.7") == "softpipe-25.0.7");
  CHECK(renderer_key("a/b:c") == "abc");

  const TempFolder folder;
  const Painted a(with_identities(sample_record())), b(with_identities(other_record()));
  const fs::path kept = a.write(folder, "a"),
                 drawn = b.write(folder, "b", {"7", "0123456789abcdef", "softpipe 25.0.7"});
  CHECK(baseline_for(kept, drawn) == kept);
  const PictureComparison c = compare_pictures("x", kept, drawn, {});
  const fs::path written = update_baseline(c, kept, drawn);
  CHECK(written.filename() == "000007@softpipe-25.0.7.png");
  CHECK(read_png(kept) == a.image);
  CHECK(read_png(written) == b.image);
  CHECK(baseline_for(kept, drawn) == written);
  CHECK(baseline_for(kept, kept) == kept);
  // a change of the state is no matter of the renderer
  const fs::path later = b.write(folder, "c", {"7", "fedcba9876543210", "softpipe 25.0.7"});
  CHECK(update_baseline(compare_pictures("x", kept, later, {}), kept, later) == kept);
  CHECK(read_png(kept) == b.image);
}

TEST_CASE("data URIs hold a file's bytes") {
  // RFC 4648 §10
  const std::string start = "data:image/png;base64,";
  for (const auto& [bytes, text] : {std::pair{"", ""},
                                    {"f", "Zg=="},
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {"fooba", "Zm9vYmE="},
                                    {"foobar", "Zm9vYmFy"}})
    CHECK(png_data_uri(bytes) == start + text);
}
