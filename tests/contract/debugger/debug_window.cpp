// The debugger's window on a real X server (Xvfb), worked by a real mouse and keyboard (xdotool): it shows what the
// same session shows without a screen, in every pixel.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <sstream>
#include <thread>

#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/debugger/loop.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kWidth = 960, kHeight = 600;

void nap(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

bool is_installed(const std::string& program) {
  std::istringstream path(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');)
    if (access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

/// Says so where one of the programs is.
bool is_missing(const std::vector<std::string>& programs) {
  const auto missing =
      std::find_if(programs.begin(), programs.end(), [](const std::string& program) { return !is_installed(program); });
  if (missing == programs.end()) return false;
  WARN(*missing << " is missing (.ci/setup checks installs it): the window was not tried");
  SUCCEED();
  return true;
}

/// A program in the background, ended with its owner.
class Background {
 public:
  Background(const std::vector<std::string>& words, const fs::path& folder, const std::string& display, int keep = -1) {
    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    const int log = open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (chdir(folder.c_str()) != 0 || dup2(log, STDOUT_FILENO) < 0 || dup2(log, STDERR_FILENO) < 0) _exit(127);
    for (int fd = 3; fd < 64; ++fd)
      if (fd != keep) close(fd);
    if (!display.empty()) setenv("DISPLAY", display.c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    execvp(argv[0], const_cast<char* const*>(argv.data()));
    _exit(127);
  }
  ~Background() {
    if (is_running()) kill(pid_, SIGTERM);
    for (int k = 0; k < 100 && is_running(); ++k) nap(20);
    if (is_running()) kill(pid_, SIGKILL), waitpid(pid_, nullptr, 0);
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  void signal(int number) { kill(pid_, number); }

  bool is_running() {
    if (!code_ && waitpid(pid_, &status_, WNOHANG) == pid_)
      code_ = WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
    return !code_;
  }
  /// The exit code; -1000 if it goes on.
  int wait(double seconds) {
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    while (is_running() && Clock::now() < end) nap(20);
    return code_.value_or(-1000);
  }

 private:
  pid_t pid_ = -1;
  int status_ = 0;
  std::optional<int> code_;
};

/// Where a script's name for a thing in the window is, in pixels.
std::pair<int, int> middle_of(DebugWindow& window, const std::string& name) {
  const UiWidget* widget = window.ui().find(name);
  CAPTURE(name);
  REQUIRE(widget != nullptr);
  REQUIRE(widget->visible);
  return {static_cast<int>(widget->area.x + 0.5f * widget->area.width),
          static_cast<int>(widget->area.y + 0.5f * widget->area.height)};
}

/// An X server whose screen is a file.
class Screen {
 public:
  explicit Screen(const fs::path& folder) : folder_(folder) {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    server_ =
        std::make_unique<Background>(std::vector<std::string>{"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen",
                                                              "0", fmt::format("{}x{}x24", kWidth, kHeight), "-fbdir",
                                                              folder.string(), "-nolisten", "tcp"},
                                     folder, "", ends[1]);
    close(ends[1]);
    char number[16] = {};
    for (std::size_t n = 0; n + 1 < sizeof number && read(ends[0], number + n, 1) == 1 && number[n] != '\n'; ++n) {
    }
    close(ends[0]);
    display_ = fmt::format(":{}", std::atoi(number));
    REQUIRE(*number != 0);
  }
  const std::string& display() const { return display_; }

  /// Pixels of the screen: an XWD file, whose header is big-endian and whose pixels are 32 bits, least byte first, blue
  /// first.
  Image picture() const {
    const std::string bytes = slurp(folder_ / "Xvfb_screen0");
    const auto word = [&](std::size_t k) {
      std::uint32_t v = 0;
      for (std::size_t i = 0; i < 4; ++i) v = v << 8 | static_cast<std::uint8_t>(bytes.at(4 * k + i));
      return v;
    };
    REQUIRE(word(4) == kWidth);
    REQUIRE(word(5) == kHeight);
    REQUIRE(word(7) == 0);    // byte order
    REQUIRE(word(11) == 32);  // bits a pixel
    const std::size_t begin = word(0) + 12 * word(19), row = word(12);
    Image image(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          image.pixel(x, y)[c] = static_cast<std::uint8_t>(
              bytes.at(begin + row * static_cast<std::size_t>(y) + 4 * static_cast<std::size_t>(x) + 2 - c));
    return image;
  }

  /// The picture once it has stood still for a while.
  Image still() const {
    Image last = picture();
    auto since = Clock::now();
    for (const auto end = since + std::chrono::seconds(20);
         Clock::now() < end && Clock::now() - since < std::chrono::milliseconds(500); nap(50))
      if (Image now = picture(); now.rgb != last.rgb) last = std::move(now), since = Clock::now();
    return last;
  }

  /// Real input, through the server.
  void hand(const std::vector<std::string>& words) const {
    std::vector<std::string> all = {"xdotool"};
    all.insert(all.end(), words.begin(), words.end());
    Background tool(all, folder_, display_);
    CAPTURE(words);
    CHECK(tool.wait(30) == 0);
  }

 private:
  fs::path folder_;
  std::unique_ptr<Background> server_;
  std::string display_;
};

}  // namespace

TEST_CASE("the window takes real mouse and keys, and shows what its recording shows without a screen, in every pixel") {
  if (is_missing({"Xvfb", "xdotool"})) return;
  const TempFolder folder;
  const fs::path scene = fs::path(IMPINGE_SOURCE_DIR) / "tests/images/suite/crate_and_ball.toml";
  // where things are
  std::map<std::string, std::pair<int, int>> at;
  DebugLayout layout;
  double friction_x = 0.0;
  {
    DebugWindow pixels(kWidth, kHeight);
    Debugger debugger(scene, {}, {}, {});
    DebugLoop loop(debugger, pixels, folder.path());
    debugger.try_execute("panel filter fric");  // as will be typed
    loop.picture();
    for (const char* name :
         {"transport/play", "parameters/contact.friction", "parameters/search", "layers/aabbs", "console/line"})
      at[name] = middle_of(pixels, name);
    friction_x = pixels.ui().slider_x(*pixels.ui().find("parameters/contact.friction"), 0.15);
    layout = debug_layout(kWidth, kHeight, 1.0f);
  }
  const auto text = [](double v) { return std::to_string(static_cast<int>(v)); };

  const Screen screen(folder.path());
  Image seen;
  {
    Background window({IMPINGE_PROGRAM, "debug", scene.string(), "--window", "--size",
                       fmt::format("{}x{}", kWidth, kHeight), "--record", "hand.script"},
                      folder.path(), screen.display());
    screen.hand({"search", "--sync", "--name", "impinge crate_and_ball.toml", "windowfocus"});
    screen.still();
    const auto click = [&](const char* name) {
      screen.hand({"mousemove", text(at[name].first), text(at[name].second)});
      nap(150);
      screen.hand({"click", "1"});
    };
    const double x = layout.view.x + 0.5 * layout.view.width, y = layout.view.y + 0.4 * layout.view.height;
    click("layers/aabbs");
    click("transport/play");
    nap(1500);
    screen.hand({"key", "space"});
    screen.still();
    screen.hand({"key", "Right", "Right", "Left"});
    click("parameters/search");
    screen.hand({"type", "--delay", "60", "fric"});
    screen.hand({"key", "Return"});
    screen.still();
    click("parameters/contact.friction");
    screen.hand({"mousedown", "1", "mousemove", text(friction_x), text(at["parameters/contact.friction"].second)});
    screen.still();
    screen.hand({"mouseup", "1"});
    screen.hand({"keydown", "ctrl"});
    nap(150);
    click("parameters/contact.friction");
    nap(150);
    screen.hand({"keyup", "ctrl"});
    screen.hand({"type", "--delay", "60", "0.275"});
    screen.hand({"key", "Return"});
    screen.still();
    screen.hand({"mousemove", text(x), text(y)});
    nap(150);
    screen.hand({"mousedown", "1", "mousemove", text(x + 40), text(y - 12), "mousemove", text(x + 60), text(y - 20)});
    nap(150);
    screen.hand({"mouseup", "1", "click", "4"});
    screen.hand({"key", "Right"});
    seen = screen.still();

    click("console/line");
    screen.hand({"type", "--delay", "60", "quit"});
    screen.hand({"key", "Return"});
    const int code = window.wait(20);
    INFO(slurp(folder / "log"));
    CHECK(code == 0);

    // the same without a screen; what came after the picture was taken is where the pointer went
    std::string script = slurp(folder / "hand.script");
    INFO(script);
    for (const char* part : {"\nlayer +aabbs\n", "\nstep ", "\nback\n", "\npanel filter fric\n",
                             "\nset contact.friction 0.275\n", "\ncamera eye "}) {
      CAPTURE(part);
      CHECK(script.find(part) != std::string::npos);
    }
    script = script.substr(0, script.rfind("ui move"));
    script += fmt::format("ui move {} {}\nshot seen.png\n", static_cast<int>(x + 60), static_cast<int>(y - 20));
    folder.write("hand.script", script);
  }
  const Outcome replay = impinge_run(folder.path(), {"debug", scene.string(), "--headless", "--script", "hand.script",
                                                     "--size", fmt::format("{}x{}", kWidth, kHeight)});
  INFO(replay.err);
  REQUIRE(replay.code == 0);
  const Image wanted = read_png(folder / "seen.png");
  REQUIRE(wanted.rgb.size() == seen.rgb.size());
  int differing = 0;
  for (std::size_t k = 0; k < wanted.rgb.size(); k += 3)
    differing += !std::equal(&wanted.rgb[k], &wanted.rgb[k] + 3, &seen.rgb[k]);
  if (differing > 0) {
    const fs::path shown = fs::path(IMPINGE_BINARY_DIR) / "window_seen.png";
    write_png(shown, seen);
    write_png(fs::path(IMPINGE_BINARY_DIR) / "window_wanted.png", wanted);
    WARN("see " << shown.string() << " and window_wanted.png beside it");
  }
  CHECK(differing == 0);
}

TEST_CASE("a window that is interrupted keeps what was done") {
  if (is_missing({"Xvfb"})) return;
  const TempFolder folder;
  const fs::path scene = fs::path(IMPINGE_SOURCE_DIR) / "tests/images/suite/crate_and_ball.toml";
  const Screen screen(folder.path());
  folder.write("a.script", "step 3\nset contact.friction 0.1\n");
  Background window({IMPINGE_PROGRAM, "debug", scene.string(), "--window", "--size", "960x600", "--script", "a.script",
                     "--record", "r.script"},
                    folder.path(), screen.display());
  screen.still();
  window.signal(SIGINT);
  CHECK(window.wait(60) == 130);
  CHECK(slurp(folder / "log").find("frame 3, state ") != std::string::npos);
  CHECK(slurp(folder / "r.script").find("step 3\nset contact.friction 0.1\n") != std::string::npos);
}

TEST_CASE("the window of a script that quits closes by itself") {
  if (is_missing({"Xvfb"})) return;
  const TempFolder folder;
  const fs::path scene = fs::path(IMPINGE_SOURCE_DIR) / "tests/images/suite/crate_and_ball.toml";
  const Screen screen(folder.path());
  folder.write("a.script", "step 3\nquit\n");
  Background window({IMPINGE_PROGRAM, "debug", scene.string(), "--window", "--size", "960x600", "--script", "a.script"},
                    folder.path(), screen.display());
  CHECK(window.wait(60) == 0);
  CHECK(slurp(folder / "log").find("frame 3, state ") != std::string::npos);
}

TEST_CASE("a window answers while it computes a frame, and Escape ends the frame") {
  if (is_missing({"Xvfb", "xdotool"})) return;
  const TempFolder folder;
  // half a minute a frame at least
  folder.write("slow.toml",
               "[simulation]\nsubsteps = 1000\n\n[[body]]\nname = \"tower\"\nkind = \"deformable\"\n"
               "shape = { box = { size = [1, 1, 1] } }\nvolume = { lattice = { cells = 24 } }\n"
               "material = { young = 1e6, poisson = 0.3, density = 1000 }\n");
  std::pair<int, int> box;
  {
    DebugWindow pixels(kWidth, kHeight);
    Debugger debugger(folder / "slow.toml", {}, {}, {});
    DebugLoop loop(debugger, pixels, folder.path());
    loop.picture();
    box = middle_of(pixels, "layers/aabbs");
  }
  const Screen screen(folder.path());
  Background window({IMPINGE_PROGRAM, "debug", "slow.toml", "--window", "--size", fmt::format("{}x{}", kWidth, kHeight),
                     "--record", "r.script"},
                    folder.path(), screen.display());
  screen.hand({"search", "--sync", "--name", "impinge slow.toml", "windowfocus"});
  const Image calm = screen.still();
  screen.hand({"mousemove", std::to_string(box.first), std::to_string(box.second)});
  nap(150);
  screen.hand({"key", "Right"});
  nap(1500);
  screen.hand({"click", "1"});
  nap(1000);
  const Image working = screen.picture();  // with its boxes, in the middle of the frame
  const UiArea view = debug_layout(kWidth, kHeight, 1.0f).view;
  int changed = 0;
  for (int y = static_cast<int>(view.y); y < static_cast<int>(view.y + view.height); ++y)
    for (int x = static_cast<int>(view.x); x < static_cast<int>(view.x + view.width); ++x)
      changed += !std::equal(calm.pixel(x, y), calm.pixel(x, y) + 3, working.pixel(x, y));
  CHECK(changed > 100);
  screen.hand({"key", "Escape"});
  nap(2000);
  window.signal(SIGINT);
  CHECK(window.wait(60) == 130);
  INFO(slurp(folder / "log"));
  CHECK(slurp(folder / "log").find("frame 0, state ") != std::string::npos);
  const std::string script = slurp(folder / "r.script");
  INFO(script);
  REQUIRE(script.find("\nseek 0\n") != std::string::npos);
  CHECK(script.find("\nlayer +aabbs\n") < script.find("\nseek 0\n"));
}
