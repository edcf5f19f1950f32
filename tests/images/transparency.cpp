// Pictures without a backdrop: what they look like over a colour is held against the same picture drawn on that colour.
#include <catch2/catch.hpp>

#include <cmath>
#include <utility>

#include "engine/io/file.hpp"
#include "tests/support/pictures/view_scenes.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/image/png.hpp"
#include "viewer/image/png_pixels.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kFlat[3] = {0x3f, 0x46, 0x50};  // the backdrop `flat`

/// As whoever lays the picture over a colour does: straight alpha.
int over(const Image& image, int x, int y, int channel, int behind) {
  const double alpha = image.alpha[static_cast<std::size_t>(y) * image.width + x] / 255.0;
  return static_cast<int>(std::lround(alpha * image.pixel(x, y)[channel] + (1.0 - alpha) * behind));
}

/// The largest difference of a channel between the picture laid over the flat backdrop and the one drawn on it.
int largest_difference(const Image& clear, const Image& flat) {
  int largest = 0;
  for (int y = 0; y < flat.height; ++y)
    for (int x = 0; x < flat.width; ++x)
      for (int c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(over(clear, x, y, c, kFlat[c]) - flat.pixel(x, y)[c]));
  return largest;
}

ViewSettings with_backdrop(ViewSettings settings, const std::string& backdrop) {
  set(settings, "view.backdrop", backdrop);
  return settings;
}

/// A picture's own pixels, with its alpha.
Image stored(const std::filesystem::path& file) {
  Image image;
  std::string reason;
  REQUIRE(decode_png_pixels(read_file(file, 1 << 26), image, reason));
  return image;
}

}  // namespace

TEST_CASE("a picture without a backdrop is, over a colour, the one drawn on that colour") {
  // surfaces, walls, floors that fade, marks, arrows, labels, panels; edges are looked at below
  ViewSettings settings =
      settings_with({"meshes", "wireframe", "contacts", "normals", "contact_forces", "labels", "aabbs"});
  settings.show_figures = settings.show_legend = true;
  settings.antialiasing = false;
  HandMadeRecord floor;
  floor.add("ball", BodyKind::dynamic, Sphere{0.5}, {0.0, 0.5, 0.0});
  floor.add("floor", BodyKind::fixed, Plane{Vec3::UnitY(), 0.0}, Vec3::Zero());
  for (const StepRecord* record : {&sample_record(), &soft_record(), &std::as_const(floor).record()}) {
    const Image clear = painted(*record, with_backdrop(settings, "transparent"), 640, 360);
    const Image flat = painted(*record, with_backdrop(settings, "flat"), 640, 360);
    REQUIRE(clear.alpha.size() == 640u * 360u);
    CHECK(flat.alpha.empty());
    // each layer that is laid over what is there rounds once, and so does the division by alpha
    CHECK(largest_difference(clear, flat) <= 4);
    CHECK(std::count(clear.alpha.begin(), clear.alpha.end(), 0) > 1000);
    CHECK(std::count(clear.alpha.begin(), clear.alpha.end(), 255) > 1000);
  }
}

TEST_CASE("alpha covers what perspective says, in parts of a pixel where an edge runs through") {
  HandMadeRecord scene;
  scene.add("ball", BodyKind::dynamic, Sphere{0.5}, Vec3::Zero());
  ViewSettings settings = with_backdrop(settings_with({"meshes"}), "transparent");
  const double distance = 4.0, radius = 0.5;
  settings.camera.look_at({0, 0, distance}, {0, 0, 0});
  settings.camera.fov_deg = 40.0;
  const Image image = painted(scene.record(), settings, 640, 360);
  double covered = 0.0;
  int partly = 0, dark = 0;
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    const int alpha = image.alpha[i];
    covered += alpha / 255.0;
    if (alpha == 0 || alpha == 255) continue;
    ++partly;
    // a colour that was not divided by its alpha would be about that much darker than the ball's rim
    const int brightest = std::max({image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]});
    dark += brightest < 60 ? 1 : 0;
  }
  const double disc = 0.5 * 360.0 / std::tan(20.0 * M_PI / 180.0) * std::tan(std::asin(radius / distance));
  CHECK(covered == Approx(M_PI * disc * disc).epsilon(0.01));
  CHECK(partly > 2.0 * disc);
  CHECK(dark == 0);
  CHECK(image.alpha.front() == 0);
  CHECK(image.alpha[180u * 640u + 320u] == 255);
}

TEST_CASE("a run without a backdrop writes pictures with alpha, and reads them laid over grey") {
  const TempFolder folder;
  folder.write("s.toml",
               "[[body]]\nname = \"ball\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.5 } }\n"
               "[view]\nbackdrop = \"transparent\"\n");
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--frames", "1", "--size", "320x200", "--out", "out"}).code ==
          0);
  const std::filesystem::path file = folder / "out/frames/000001.png";
  CHECK(read_file(file, 1 << 26)[25] == 6);  // RGBA
  const Image clear = stored(file), laid = read_png(file);
  REQUIRE(clear.alpha.size() == 320u * 200u);
  CHECK(laid.alpha.empty());
  CHECK(clear.alpha[199u * 320u] == 0);
  for (int c = 0; c < 3; ++c) CHECK(laid.pixel(0, 199)[c] == kFlat[c]);
  for (int y = 0; y < 200; y += 7)
    for (int x = 0; x < 320; x += 7)
      for (int c = 0; c < 3; ++c) CHECK(std::abs(laid.pixel(x, y)[c] - over(clear, x, y, c, kFlat[c])) <= 1);
  // other backdrops write what they wrote
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--frames", "1", "--size", "320x200", "--out", "dark", "--set",
                                      "view.backdrop=dark"})
              .code == 0);
  CHECK(read_file(folder / "dark/frames/000001.png", 1 << 26)[25] == 2);  // RGB
  CHECK(stored(folder / "dark/frames/000001.png").alpha.empty());
}
