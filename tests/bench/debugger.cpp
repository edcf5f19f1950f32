// The debugger's window while it is paused and orbited, and while a frame of a minute is computed.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "engine/core/parallel.hpp"
#include "tests/support/median.hpp"
#include "tests/support/program/bench_arguments.hpp"
#include "tests/support/program/slow_scenes.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/debugger/window_loop.hpp"

using namespace impinge;
using namespace impinge::test;
using impinge::test::median;

namespace {

namespace fs = std::filesystem;
constexpr int kWidth = 1280, kHeight = 720, kFrames = 60;

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Dragons of 4,998 triangles, fallen on a floor.
std::string scene_of(int dragons) {
  std::string text =
      "[scene]\nallow_outside_files = true\n[contact]\nfriction = 0.4\n[[body]]\nname = \"floor\"\nkind = "
      "\"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n";
  for (int k = 0; k < dragons; ++k)
    text += fmt::format(
        "[[body]]\nname = \"dragon_{}\"\nkind = \"dynamic\"\nsurface = \"{}\"\nmaterial = {{ density = 900 "
        "}}\nposition = [{}, 0.06, {}]\nrotation = [0, {}, 0]\n",
        k, (fs::path(IMPINGE_SOURCE_DIR) / "scenes/meshes/dragon/dragon_5k.off").string(), 0.2 * (k % 4), 0.2 * (k / 4),
        40 * k);
  return text;
}

DebuggerOptions options_of(const DebugWindow& window) {
  DebuggerOptions options;
  options.session.height = kHeight;
  options.session.width = static_cast<int>(kHeight * window.view_aspect());
  return options;
}

/// The debugger with its window, without a screen.
struct Bench {
  test::TempFolder folder;
  DebugWindow window{kWidth, kHeight};
  Debugger debugger;
  DebugLoop loop{debugger, window, folder.path()};

  explicit Bench(const std::string& scene)
      : debugger((folder.write("scene.toml", scene), folder / "scene.toml"), {}, {}, options_of(window)) {}
  void line(const std::string& text) {
    static const std::string kBench = "bench";
    loop.run_line({text, &kBench, 1, 1});
  }
};

void measure(int dragons) {
  Bench bench(scene_of(dragons));
  DebugWindow& window = bench.window;
  DebugLoop& loop = bench.loop;
  bench.line("step 30");
  bench.line("ui move 640 270");
  bench.line("ui press left");
  Image pixels;
  std::vector<double> orbit, panels, read;
  for (int k = 0; k < kFrames; ++k) {
    const double start = now_ms();
    window.ui().add({UiEvent::move, 640.0f + 3.0f * static_cast<float>(k + 1), 270.0f});
    loop.tick();  // shows the move before this one, as while a hand moves on
    const double drawn = now_ms();
    window.read(pixels);
    orbit.push_back(now_ms() - start);
    read.push_back(now_ms() - drawn);
  }
  bench.line("ui release left");
  for (int k = 0; k < kFrames; ++k) {
    const double start = now_ms();
    loop.tick();  // nothing new in the scene
    panels.push_back(now_ms() - start);
  }
  std::size_t triangles = 0;
  for (const BodyRecord& body : bench.debugger.model().record->bodies)
    if (const SurfaceMesh* mesh = body.shape->mesh()) triangles += mesh->mesh.triangles.size();
  const double whole = median(orbit);
  fmt::print("{:>9} | {:>8} | {:>5.1f} | {:>5.1f} | {:>5.1f} | {:>5.1f} | {:>5.1f}\n", triangles,
             bench.debugger.model().record->contacts.size(), whole, whole - median(panels) - median(read),
             median(panels), median(read), 1e3 / whole);
}

/// A hand that moves the mouse some time after it saw what the last move did.
class Hand : public Screen {
 public:
  explicit Hand(int moves) : moves_(moves) {}
  bool take_input(Ui& ui, int) override {
    if (!has_begun_) {
      has_begun_ = true;
      ui.add({UiEvent::move, 640.0f, 270.0f});
      ui.add({UiEvent::press});
      next_ = now_ms() + kStart;
    }
    if (!waits_ && now_ms() >= next_) {
      ui.add({UiEvent::move, 640.0f + 3.0f * static_cast<float>(waited_.size() + 1), 270.0f});
      waits_ = true;
    }
    return static_cast<int>(waited_.size()) < moves_;
  }
  bool is_exposed() const override { return false; }
  void show(const Image&) override {
    if (!waits_) return;
    waits_ = false;
    waited_.push_back(now_ms() - next_);
    next_ = now_ms() + kBetween;
  }
  const std::vector<double>& waited() const { return waited_; }

 private:
  static constexpr double kStart = 2000.0, kBetween = 30.0;
  int moves_;
  bool has_begun_ = false, waits_ = false;
  double next_ = 0.0;
  std::vector<double> waited_;  // ms, by move
};

void measure_meanwhile(const char* name, const std::string& scene) {
  Bench bench(scene);
  bench.line("play");
  std::vector<std::unique_ptr<Screen>> screens;
  screens.push_back(std::make_unique<Hand>(200));
  const std::atomic<bool> interrupted = false;
  const double start = now_ms();
  show_on_screens(bench.loop, bench.window, screens, interrupted, [] {});
  std::vector<double> waited = dynamic_cast<const Hand&>(*screens[0]).waited();
  std::sort(waited.begin(), waited.end());
  fmt::print("{:<28} | {:>5} | {:>6.1f} | {:>6.1f} | {:>6.1f} | {:>6}\n", name, waited.size(), median(waited),
             waited[waited.size() * 95 / 100], waited.back(), bench.loop.frame());
  fmt::print("  {:.0f} s\n", 1e-3 * (now_ms() - start));
}

}  // namespace

int main(int argc, char** argv) {
  std::string only;
  BenchArguments arguments(
      "bench_debugger",
      "The debugger's window at 1280 x 720 while it is paused and the view is orbited by the mouse: what a\n"
      "frame of it costs, from the mouse's move to the pixels, and what of that is the scene and what the\n"
      "panels, ms. Everything is drawn by the processor. Then while a frame of a minute is computed: how\n"
      "long after a move its pixels are there.");
  arguments.word("scene", only, one_of({"boxes", "few", "self", "block"}),
                 "boxes, few, self or block: only while that is computed; all unless given");
  arguments.read_or_exit(argc, argv);
  {
    const DebugWindow window(kWidth, kHeight);
    fmt::print("renderer: {}, {} threads\n", window.renderer_name(), thread_count());
  }
  fmt::print("triangles | contacts | orbit, ms | of it scene | panels | read | frames/s\n");
  if (only.empty())
    for (const int dragons : {2, 14, 40}) measure(dragons);
  fmt::print("while a frame is computed     | moves | median, ms | 95 % | largest | frames made\n");
  if (only.empty() || only == "boxes") measure_meanwhile("200 boxes in each other", test::overlapping_boxes(200));
  if (only.empty() || only == "few") measure_meanwhile("60 boxes in each other", test::overlapping_boxes(60));
  if (only.empty() || only == "self") measure_meanwhile("a soft ball against itself", test::self_contact(24));
  if (only.empty() || only == "block") measure_meanwhile("a soft block, 90,000 unknowns", test::soft_block(30));
}
