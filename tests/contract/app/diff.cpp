// impinge diff and run --ids, as a user runs them.
#include <catch2/catch.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "tests/support/pictures/picture_scene.hpp"
#include "viewer/image/id_image.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const std::string kScene = std::string(kCrateOnSlab) + R"(position = [0, 0.26, 0]
rotation = [0, 20, 0]
[[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.3 } }
position = [0.1, 1.0, 0]
)" + kFrontView + R"(layers = ["meshes", "contacts", "normals"]
)";

struct Runs {
  TempFolder folder;
  Runs() { folder.write("s.toml", kScene); }
  void run(const std::string& out, const std::vector<std::string>& more = {}) const {
    REQUIRE(told(folder, {"run", "s.toml", "--out", out, "--frames", "6", "--size", "320x180", "--quiet"}, more).code ==
            0);
  }
  Outcome diff(const std::vector<std::string>& words) const { return told(folder, {"diff"}, words); }
};

/// An environment variable for the life of a scope; the programs started meanwhile see it.
struct Setting {
  std::string name;
  Setting(const std::string& n, const char* value) : name(n) { setenv(name.c_str(), value, 1); }
  ~Setting() { unsetenv(name.c_str()); }
};

std::string renderer_of(const fs::path& picture) {
  for (const auto& [keyword, text] : read_png_text(picture))
    if (keyword == "impinge:renderer") return text;
  return "";
}

}  // namespace

TEST_CASE("the id buffer of --ids changes no pixel and no state, and tells which bodies the changes belong to") {
  const Runs runs;
  runs.run("plain");
  runs.run("ids", {"--ids"});
  CHECK_FALSE(fs::exists(runs.folder / "plain/ids"));
  for (int frame = 0; frame <= 6; ++frame) {
    const std::string name = fmt::format("{:06}.png", frame);
    CHECK(slurp(runs.folder / ("plain/frames/" + name)) == slurp(runs.folder / ("ids/frames/" + name)));
    const IdImage ids = read_ids(runs.folder / ("ids/ids/" + name));
    CHECK(ids.width == 320);
    CHECK(ids.objects.size() >= 3);
  }
  CHECK(impinge_run(runs.folder.path(), {"replay", "ids"}).code == 0);
  runs.run("bare", {"--ids", "--set", "view.layers=[\"meshes\", \"contacts\"]"});
  const Outcome outcome = runs.diff({"ids", "bare"});
  CHECK(outcome.code == 1);
  CHECK(holds(outcome.out, "normals: 4 arrows between floor and crate missing (of 4 in A"));
  CHECK(holds(outcome.out, "only the drawing changed"));
  CHECK_FALSE(holds(outcome.out, "ball changed"));
}

TEST_CASE("an interrupted run with ids goes on with ids") {
  const Runs runs;
  runs.run("whole", {"--ids"});
  runs.run("parts", {"--ids"});
  fs::remove(runs.folder / "parts/done");
  fs::remove(runs.folder / "parts/ids/000005.png");  // as if killed while it was written
  runs.run("parts", {"--ids", "--resume"});
  for (int frame = 0; frame <= 6; ++frame)
    CHECK(slurp(runs.folder / fmt::format("parts/ids/{:06}.png", frame)) ==
          slurp(runs.folder / fmt::format("whole/ids/{:06}.png", frame)));
  // from its own run.toml it goes on as it began, with nothing said again
  const Outcome longer = impinge_run(runs.folder.path(), {"run", "parts/run.toml", "--out", "parts", "--resume",
                                                          "--size", "320x180", "--frames", "8"});
  INFO(longer.err);
  CHECK(longer.code == 0);
  CHECK(fs::exists(runs.folder / "parts/ids/000008.png"));
}

TEST_CASE("pictures that are looked at otherwise say so: the camera, the layers, a row of the view") {
  const Runs runs;
  runs.run("plain");
  const auto says = [&](const std::vector<std::string>& more, const std::string& words) {
    std::vector<std::string> all = more;
    all.insert(all.end(), {"--force"});
    runs.run("other", all);
    const Outcome outcome = runs.diff({"plain", "other"});
    INFO(outcome.out);
    CHECK(outcome.code == 1);
    CHECK(holds(outcome.out, "only the drawing changed, since " + words));
  };
  says({"--set", "view.camera.fov=20"}, "the camera moved (fov is ");
  says({"--set", "view.layers=[\"meshes\"]"}, "view.layers is ");
  says({"--set", "view.backdrop=flat"}, "view.backdrop is as usual in A, flat in B");
}

TEST_CASE("another vector width or instruction set of the rasteriser is no difference") {
  const Runs runs;
  runs.run("here");
  std::string other;
  for (const auto& [name, value] : {std::pair{"GALLIUM_OVERRIDE_CPU_CAPS", "sse2"},
                                    {"LP_NATIVE_VECTOR_WIDTH", "128"},
                                    {"GALLIUM_OVERRIDE_CPU_CAPS", "nosse"}}) {
    const Setting setting(name, value);
    const std::string out = std::string("there_") + value;
    runs.run(out);
    other += renderer_of(runs.folder / (out + "/frames/000000.png"));
    const Outcome outcome = runs.diff({"here", out});
    INFO(name << "=" << value);
    CHECK(outcome.code == 0);
    CHECK(outcome.out == "7 pictures compared, no difference beyond the tolerance\n");
  }
  // the setting did reach the renderer
  CHECK(holds(other, "128 bits"));
}

TEST_CASE("the report stands alone and shows each picture that differs, the worst first") {
  const Runs runs;
  // without the legend, which is larger where there are contacts: then the crates are ever farther apart
  runs.run("a", {"--set", "view.panel.legend=false"});
  runs.run("b", {"--set", "simulation.gravity=[0,-30,0]", "--set", "view.panel.legend=false"});
  const Outcome outcome = runs.diff({"a", "b", "--out", "shown"});
  CHECK(outcome.code == 1);
  CHECK(holds(outcome.out, "the state changed (hash "));
  CHECK(holds(outcome.out, "shown/report.html"));
  const std::string page = slurp(runs.folder / "shown/report.html");
  CHECK(holds(page, "data:image/png;base64,"));
  for (const char* outside : {"http:", "https:", "<link", "src=\"/", "@import"}) CHECK_FALSE(holds(page, outside));
  CHECK(fs::exists(runs.folder / "shown/000006.png"));
  CHECK_FALSE(fs::exists(runs.folder / "shown/000000.png"));  // the same state and picture
  const std::size_t begin = page.find("<tbody>"), row = page.find("<tr><td>", begin);
  CHECK(page.substr(row + 8, 10) == "000006.png");
  // where there is nothing more to show it goes
  CHECK(runs.diff({"a", "b", "--out", "gone"}).code == 1);
  CHECK(runs.diff({"a", "a", "--out", "gone"}).code == 0);
  CHECK_FALSE(fs::exists(runs.folder / "gone/report.html"));
  // used in a real browser
  const fs::path tools = fs::path(IMPINGE_SOURCE_DIR) / "tests/tools";
  const TempFolder said;
  const int status = std::system(fmt::format("python3 {}/diff_in_browser.py {} > {} 2>&1", tools.string(),
                                             (runs.folder / "shown/report.html").string(), (said / "out").string())
                                     .c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 77 || code == 127) {
    WARN("not opened: this needs python3 and chromium");
    return;
  }
  const std::string checks = slurp(said / "out");
  INFO(checks);
  CHECK(code == 0);
  CHECK_FALSE(holds(checks, "FAILED"));
  CHECK(holds(checks, "ok      the slider wipes"));
}

TEST_CASE(
    "a diff with --update makes the baselines what there is, says so, and leaves alone what is within the limits") {
  const Runs runs;
  runs.run("a");
  runs.run("b", {"--set", "simulation.gravity=[0,-30,0]"});
  fs::create_directory(runs.folder / "kept");
  for (const char* name : {"000000.png", "000005.png", "000006.png"})
    fs::copy(runs.folder / ("a/frames/" + std::string(name)), runs.folder / ("kept/" + std::string(name)));
  const std::string first = slurp(runs.folder / "kept/000000.png");
  fs::create_directory(runs.folder / "now");
  for (const char* name : {"000000.png", "000005.png", "000006.png", "000004.png"})
    fs::copy(runs.folder / ("b/frames/" + std::string(name)), runs.folder / ("now/" + std::string(name)));
  CHECK(runs.diff({"kept", "now"}).code == 1);
  const Outcome outcome = runs.diff({"kept", "now", "--update"});
  CHECK(outcome.code == 0);
  CHECK(holds(outcome.out, "new: kept/000004.png"));
  CHECK(holds(outcome.out, "rewrote kept/000006.png"));
  CHECK_FALSE(holds(outcome.out, "000000.png"));
  CHECK(slurp(runs.folder / "kept/000000.png") == first);
  CHECK(runs.diff({"kept", "now"}).code == 0);
  CHECK(holds(runs.diff({"kept", "now", "--update"}).out, "0 rewritten"));
  // what B no longer has is kept
  fs::remove(runs.folder / "now/000004.png");
  const Outcome gone = runs.diff({"kept", "now", "--update"});
  CHECK(gone.code == 1);
  CHECK(holds(gone.out, "kept kept/000004.png"));
  CHECK(fs::exists(runs.folder / "kept/000004.png"));
  // a folder of baselines that is not there yet
  CHECK(runs.diff({"fresh", "now", "--update"}).code == 0);
  CHECK(runs.diff({"fresh", "now"}).code == 0);
  check_refused(runs.folder, {"diff", "a", "b", "--update"}, "a: is a run's folder", "--update");
}

TEST_CASE("a diff with --update keeps ids that tell of the picture they lie beside") {
  const Runs runs;
  runs.run("plain");
  runs.run("ids", {"--ids"});
  const std::string frame = "000006.png", kept_ids = "kept/ids/" + frame;
  const auto ids = [&](const std::string& run) { return slurp(runs.folder / (run + "/ids/" + frame)); };
  fs::create_directory(runs.folder / "kept");
  fs::copy(runs.folder / ("plain/frames/" + frame), runs.folder / ("kept/" + frame));
  const std::string picture = slurp(runs.folder / ("kept/" + frame));
  const auto update = [&](const std::string& run) {
    return runs.diff({"kept/" + frame, run + "/frames/" + frame, "--update"}).out;
  };

  // the same picture: nothing to rewrite, but ids that were not there
  CHECK(holds(update("plain"), "1 picture compared, 0 rewritten, 0 new\n"));
  const std::string first = update("ids");
  CHECK(holds(first, "wrote its ids kept/ids/" + frame));
  CHECK(holds(first, "0 rewritten, 0 new, ids alone written of 1"));
  CHECK(slurp(runs.folder / kept_ids) == ids("ids"));
  CHECK(slurp(runs.folder / ("kept/" + frame)) == picture);
  CHECK(update("ids") == "1 picture compared, 0 rewritten, 0 new\n");
  // a body of another name: the same pixels, other objects
  runs.folder.write("s.toml", replaced(kScene, "name = \"crate\"", "name = \"chest\""));
  runs.run("renamed", {"--ids"});
  CHECK(holds(update("renamed"), "wrote its ids"));
  CHECK(slurp(runs.folder / kept_ids) == ids("renamed"));
  CHECK(slurp(runs.folder / ("kept/" + frame)) == picture);
  // the same picture without ids: those that there are hold
  CHECK(holds(update("plain"), "0 rewritten, 0 new\n"));
  CHECK(fs::exists(runs.folder / kept_ids));
  // another picture, with and without ids
  runs.run("fast", {"--ids", "--set", "simulation.gravity=[0,-30,0]"});
  CHECK(holds(update("fast"), "rewrote kept/" + frame + " with its ids"));
  CHECK(slurp(runs.folder / kept_ids) == ids("fast"));
  CHECK(holds(update("plain"), "rewrote kept/" + frame + "; B has no ids of it, so the old ones were removed"));
  CHECK_FALSE(fs::exists(runs.folder / kept_ids));
}

TEST_CASE("a baseline by another renderer gets an alternate, and each renderer its own from then on") {
  const Runs runs;
  runs.run("a");
  fs::create_directory(runs.folder / "kept");
  fs::create_directory(runs.folder / "now");
  const fs::path frame = runs.folder / "a/frames/000006.png";
  fs::copy(frame, runs.folder / "kept/x.png");
  Image other = read_png(frame);
  for (int x = 100; x < 140; ++x) other.pixel(x, 90)[0] = 255;
  PngText text = read_png_text(frame);
  for (auto& [keyword, value] : text)
    if (keyword == "impinge:renderer") value = "softpipe 25.0.7";
  write_png(runs.folder / "now/x.png", other, text);
  const Outcome found = runs.diff({"kept", "now"});
  CHECK(found.code == 1);
  CHECK(holds(found.out, "only the renderer changed (A by llvmpipe"));
  const Outcome updated = runs.diff({"kept", "now", "--update"});
  CHECK(updated.code == 0);
  CHECK(holds(updated.out, "wrote the alternate kept/x@softpipe-25.0.7.png"));
  CHECK(slurp(runs.folder / "kept/x.png") == slurp(frame));
  CHECK(runs.diff({"kept", "now"}).out == "1 picture compared, no difference beyond the tolerance\n");
  fs::copy(frame, runs.folder / "now/x.png", fs::copy_options::overwrite_existing);
  CHECK(runs.diff({"kept", "now"}).code == 0);
}

TEST_CASE("pictures that can't be compared are refused with one clear message") {
  const Runs runs;
  runs.run("a");
  const TempFolder& folder = runs.folder;
  const std::string frame = "a/frames/000003.png";
  check_refused(folder, {"diff", frame, "nothing.png"}, "nothing.png: ", "there is no such file");
  check_refused(folder, {"diff", "nothing.png", frame}, "nothing.png: ", "there is no such file");
  check_refused(folder, {"diff", frame, "a"}, frame + " and a: ", "two of a kind");
  folder.write("text.png", "no picture");
  check_refused(folder, {"diff", frame, "text.png"}, "text.png: ", "is not a PNG file");
  check_refused(folder, {"diff", "text.png", frame}, "text.png: ", "is not a PNG file");
  const std::string bytes = slurp(folder / frame);
  folder.write("cut.png", bytes.substr(0, bytes.size() / 2));
  check_refused(folder, {"diff", frame, "cut.png"}, "cut.png: ", "cut short");
  check_refused(folder, {"diff", "text.png", frame, "--update"}, "text.png: ", "is not a PNG file");
  check_refused(folder, {"diff", frame, frame, "--mask", "none.png"}, "none.png: ", "no such file");
  write_png(folder / "mask.png", Image(10, 10));
  check_refused(folder, {"diff", frame, frame, "--mask", "mask.png"}, "the mask has 10 x 10 pixels",
                "draw it over that picture");
  folder.write("empty/x.txt", "");
  check_refused(folder, {"diff", "empty", "empty"}, "empty and empty: ", "no PNG files");
  // where the report can't be
  check_refused(folder, {"diff", "a/frames/000000.png", "a/frames/000006.png", "--out", "text.png"},
                "text.png: can't be made", "choose another --out");
  check_refused(folder, {"diff", "a/frames/000000.png", "a/frames/000006.png", "--out", "/proc/impinge"},
                "/proc/impinge: can't be made", "choose another --out");

  // of another size: a difference, since both are fine pictures
  write_png(folder / "small.png", Image(160, 90));
  const Outcome size = runs.diff({"small.png", frame});
  CHECK(size.code == 1);
  CHECK(holds(size.out, "sizes differ: A has 160x90 pixels, B 320x180"));
}
