// The debugger's panels, each as a kept picture, and where they are. IMPINGE_UPDATE_BASELINES=1 writes the pictures
// anew; look at them before they are committed.
#include <catch2/catch.hpp>

#include <filesystem>

#include <imgui.h>

#include "engine/core/types.hpp"
#include "tests/support/pictures/text_faults.hpp"
#include "tests/support/pictures/view_scenes.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/debugger/loop.hpp"
#include "viewer/draw/palette.hpp"
#include "viewer/image/difference.hpp"
#include "viewer/image/png.hpp"
#include "viewer/panels/debug/outliner.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

struct PanelSession {
  DebugWindow window;
  Debugger debugger;
  DebugLoop loop;

  PanelSession(int width, int height)
      : window(width, height),
        debugger(fs::path(IMPINGE_SOURCE_DIR) / "tests/images/suite/crate_and_ball.toml", {}, {},
                 options(width, height, window)),
        loop(debugger, window, fs::temp_directory_path()) {}
  static DebuggerOptions options(int, int height, const DebugWindow& window) {
    DebuggerOptions o;
    o.session.height = height;
    o.session.width = static_cast<int>(height * window.view_aspect());
    return o;
  }
  PanelSession& run(const std::vector<std::string>& lines) {
    static const std::string kTest = "test";
    for (const std::string& line : lines) loop.run_line({line, &kTest, 1, 1});
    return *this;
  }
};

const std::vector<std::string> kLines = {"step 60",
                                         "set contact.friction 0.25",
                                         "layer +aabbs -normals",
                                         "panel sort gap",
                                         "step 10",
                                         "select contact 1",
                                         "panel plot +max_penetration_m +potential_J",
                                         "back 5"};

void key(PanelSession& session, UiEvent::Kind kind, const char* name) {
  const auto it = std::find(key_names().begin(), key_names().end(), name);
  session.window.ui().add({kind, 0, 0, static_cast<int>(it - key_names().begin())});
}

Image crop(const Image& whole, const UiArea& area) {
  const int x0 = static_cast<int>(area.x), y0 = static_cast<int>(area.y);
  Image part(std::min(static_cast<int>(area.width), whole.width - x0),
             std::min(static_cast<int>(area.height), whole.height - y0));
  for (int y = 0; y < part.height; ++y) std::copy_n(whole.pixel(x0, y0 + y), 3 * part.width, part.pixel(0, y));
  return part;
}

void check_baseline(const std::string& name, const Image& now, std::uintmax_t most_bytes) {
  CAPTURE(name);
  const fs::path file = fs::path(IMPINGE_SOURCE_DIR) / "tests/images/baselines" / ("debug_" + name + ".png");
  if (updating()) write_png(file, now);
  REQUIRE(fs::exists(file));
  const Image kept = read_png(file);
  const Difference difference = compare(kept, now);
  if (!difference.same) {
    const fs::path shown = fs::path(IMPINGE_BINARY_DIR) / ("debug_" + name + "_difference.png");
    write_png(shown, difference_panels(kept, now, difference));
    WARN("see " << shown.string());
  }
  INFO(difference.reason);
  CHECK(difference.same);
  CHECK(fs::file_size(file) < most_bytes);
}

std::vector<std::pair<std::string, UiArea>> areas(const DebugLayout& l) {
  std::vector<std::pair<std::string, UiArea>> all = {{"view", l.view}};
  for (std::size_t i = 0; i < panels().size(); ++i)
    if (panels()[i].shares.empty()) all.emplace_back(panels()[i].name, l.panels[i]);
  return all;
}

}  // namespace

TEST_CASE("the debugger's panels are those of the baselines") {
  PanelSession session(1280, 720);
  session.run(kLines);
  const Image whole = session.loop.picture();
  check_baseline("window", whole, 200000);
  const DebugLayout layout = debug_layout(1280, 720, 1.0f);
  for (const auto& [name, area] : areas(layout))
    if (name != "view") check_baseline(name, crop(whole, area), 60'000);

  session.run({"select body crate 3", "ui key f1"});
  const Image help = session.loop.picture();
  check_baseline("help",
                 crop(help, {layout.view.x + 0.2f * layout.view.width, layout.view.y + 0.2f * layout.view.height,
                             0.6f * layout.view.width, 0.6f * layout.view.height}),
                 60'000);
  check_baseline("inspector_of_a_body", crop(help, layout.area("inspector")), 60'000);
}

TEST_CASE("the outliner's tabs are those of the baselines") {
  PanelSession session(1280, 720);
  session.run(kLines).run({"panel front outliner", "select body crate", "hide ball", "lock floor"});
  const UiArea area = debug_layout(1280, 720, 1.0f).area("outliner");
  for (const std::string& tab : outliner_tabs())
    check_baseline("outliner_" + tab, crop(session.run({"panel tab " + tab}).loop.picture(), area), 40'000);
}

TEST_CASE("the ledger is that of the baselines, of all bodies and of one") {
  PanelSession session(1280, 720);
  session.run(kLines).run({"panel front ledger", "select none", "seek 18"});  // the ball lands
  const UiArea area = debug_layout(1280, 720, 1.0f).area("ledger");
  check_baseline("ledger", crop(session.loop.picture(), area), 40'000);
  check_baseline("ledger_of_a_body", crop(session.run({"select body crate"}).loop.picture(), area), 40'000);
}

TEST_CASE("no text of the ledger is cut off or lies over another, small or large") {
  for (const auto& [width, height] : {std::pair(1280, 720), {3840, 2160}, {kLeastWidth, kLeastHeight}}) {
    PanelSession session(width, height);
    session.run(kLines).run({"panel front ledger"});
    const DebugLayout layout = debug_layout(width, height, session.window.ui().unit());
    for (const char* deed : {"select body crate", "select none", "select body floor", "seek 1", "seek 0"}) {
      CAPTURE(width, height, deed);
      session.run({deed}).loop.picture();
      const TextFaults faults = text_faults(*ImGui::GetDrawData(), layout.area("ledger"));
      CHECK(faults.letters > 10);
      CHECK(faults.cut_off == 0);
      CHECK(faults.over_others == 0);
    }
  }
}

TEST_CASE("no text of tables, numbers and plots is cut off or lies over another, small or large") {
  for (const auto& [width, height] : {std::pair(1280, 720), {3840, 2160}, {kLeastWidth, kLeastHeight}}) {
    PanelSession session(width, height);
    session.run(kLines).run({"panel front outliner", "panel columns contacts +used +gap0"});
    const DebugLayout layout = debug_layout(width, height, session.window.ui().unit());
    for (const char* deed :
         {"select body crate", "select body floor", "select contact 0", "panel tab groups",
          "panel columns groups +force", "panel tab pairs", "panel tab bodies", "panel columns bodies +kind +mass",
          "panel columns bodies -speed", "seek 0", "hide ball"}) {
      session.run({deed}).loop.picture();
      for (const char* panel : {"outliner", "contacts", "inspector", "timeline"}) {
        CAPTURE(width, height, deed, panel);
        const TextFaults faults = text_faults(*ImGui::GetDrawData(), layout.area(panel));
        CHECK(faults.letters > 10);
        CHECK(faults.cut_off == 0);
        CHECK(faults.over_others == 0);
      }
    }
  }
}

TEST_CASE("the arrow of the column that a table is sorted by stands beside that column's word") {
  PanelSession session(1280, 720);
  session.run(kLines);
  for (const char* column : {"gap", "a", "index"}) {
    CAPTURE(column);
    // what turns with the order is the arrow alone, and without it there is the word
    const Image plain = session.run({"panel sort normal"}).loop.picture();
    const Image up = session.run({fmt::format("panel sort {}", column)}).loop.picture();
    const Image down = session.run({fmt::format("panel sort {} down", column)}).loop.picture();
    const UiWidget* head = session.window.ui().find(fmt::format("contacts/sort:{}", column));
    REQUIRE(head != nullptr);
    int left = 100000, right = -1, ink_left = 100000, ink_right = -1;
    const auto at = [&](double v) { return static_cast<int>(v); };
    const int x0 = at(head->area.x), x1 = at(head->area.x + head->area.width) - 1, y0 = at(head->area.y) + 2;
    const int y1 = at(head->area.y + head->area.height) - 2;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const bool turns = !std::equal(up.pixel(x, y), up.pixel(x, y) + 3, down.pixel(x, y));
        if (turns) left = std::min(left, x), right = std::max(right, x);
        if (plain.pixel(x, y)[0] > 150) ink_left = std::min(ink_left, x), ink_right = std::max(ink_right, x);
      }
    REQUIRE(right > left);
    REQUIRE(ink_right >= ink_left);
    CHECK(std::min(std::abs(ink_left - right), std::abs(left - ink_right)) < 8);
  }
}

TEST_CASE("texts that are cut off or lie over each other are found") {
  PanelSession session(960, 600);
  Ui& ui = session.window.ui();
  const auto faults = [&](const std::function<void(ImDrawList&)>& draw) {
    ui.begin(960, 600);
    draw(*ImGui::GetForegroundDrawList());
    return text_faults(ui.end(), {0, 0, 960, 600});
  };
  const auto text = [](ImDrawList& list, float x, float y, const char* words) {
    list.AddText({x, y}, 0xffffffff, words);
  };
  const TextFaults good = faults([&](ImDrawList& list) { text(list, 20, 20, "one two"), text(list, 20, 40, "three"); });
  CHECK(good.letters == 11);
  CHECK(good.cut_off + good.over_others == 0);
  CHECK(faults([&](ImDrawList& list) { text(list, 20, 20, "one"), text(list, 30, 22, "two"); }).over_others > 0);
  CHECK(faults([&](ImDrawList& list) {
          list.PushClipRect({0, 0}, {31, 100});
          text(list, 20, 20, "one");
          list.PopClipRect();
        }).cut_off > 0);
}

TEST_CASE("a frame that is gone back to looks as it did") {
  PanelSession session(960, 600);
  const DebugLayout layout = debug_layout(960, 600, 1.0f);
  const Image first = session.run({"step 40", "select body ball"}).loop.picture();
  const Image again = session.run({"step 30", "back 30"}).loop.picture();
  for (const auto& [name, area] : areas(layout)) {
    CAPTURE(name);
    const bool tells_of_the_past = name == "transport" || name == "timeline" || name == "console";
    CHECK((crop(first, area).rgb == crop(again, area).rgb) != tells_of_the_past);
  }
}

TEST_CASE("ctrl z undoes, with shift it does again, and b writes a bundle") {
  const TempFolder folder;
  PanelSession session(960, 600);
  DebugLoop loop(session.debugger, session.window, folder.path());
  const auto press = [&](const std::vector<const char*>& names) {
    for (const char* name : names) key(session, UiEvent::key_down, name);
    for (const char* name : names) key(session, UiEvent::key_up, name);
    while (session.window.ui().has_events()) loop.tick();
    loop.tick();
  };
  const Parameter& friction = *session.debugger.model().rows->find("contact.friction");
  const ParameterValue before = friction.get();
  session.run({"step 5", "set contact.friction 0.125"});
  press({"z"});
  CHECK(friction.get() == ParameterValue(0.125));
  press({"ctrl", "z"});
  CHECK(friction.get() == before);
  press({"ctrl", "shift", "z"});
  CHECK(friction.get() == ParameterValue(0.125));
  CHECK(session.debugger.recording({-1, -1}) ==
        std::vector<std::string>{"step 5", "set contact.friction 0.125", "undo", "redo"});
  press({"b"});
  const std::string line = session.debugger.recording({-1, -1}).back();
  REQUIRE(line.starts_with("bundle crate_and_ball_000005_"));
  CHECK(is_bundle(folder / line.substr(7)));
}

TEST_CASE("what is typed into one window and not entered shows in no other") {
  const Image fresh = PanelSession(960, 600).loop.picture();
  PanelSession console(960, 600), slider(960, 600);
  console.run({"ui click console/line", "ui text quit", "ui click transport/frame"});
  key(slider, UiEvent::key_down, "ctrl");  // and a click: a field for the value takes the slider's place
  slider.run({"ui click parameters/contact.friction"});
  for (PanelSession* typed : {&console, &slider}) {
    CHECK(typed->loop.picture().rgb != fresh.rgb);
    CHECK(PanelSession(960, 600).loop.picture().rgb == fresh.rgb);
  }
}

TEST_CASE("a window of which only parts are drawn again is the window drawn as a whole") {
  PanelSession session(960, 600);
  const char* const deeds[] = {"step 20",
                               "ui move 480 200",
                               "ui press left",
                               "ui move 520 220",
                               "ui move 560 210",
                               "ui release left",
                               "ui wheel 2",
                               "select contact 0",
                               "ui move 100 60",
                               "ui wait 3",
                               "ui key f1",
                               "ui key f1",
                               "panel filter fric",
                               "step 3",
                               "panel sort gap down",
                               "ui click timeline/columns",
                               "ui key escape",
                               "back 4",
                               "ui click layers/aabbs",
                               "ui move 700 300",
                               "ui wait 2",
                               "set contact.friction 0.3",
                               "play",
                               "ui wait 4"};
  int changed = 0;
  Image before = session.loop.picture();
  for (const char* deed : deeds) {
    CAPTURE(deed);
    session.run({deed});
    const Image parts = session.loop.picture();
    session.window.forget();
    const Image whole = session.loop.picture();
    CHECK((parts.rgb == whole.rgb));
    changed += whole.rgb != before.rgb;
    before = whole;
  }
  CHECK(changed > 15);
}

TEST_CASE("no two panels overlap, and all lie in the window") {
  for (const auto& [width, height] : {std::pair(1280, 720),
                                      {1920, 1080},
                                      {3840, 2160},
                                      {2560, 1080},
                                      {kLeastWidth, kLeastHeight},
                                      {4000, 500},
                                      {800, 2000}}) {
    for (const int scale : {debug_scale(height), 1}) {
      CAPTURE(width, height, scale);
      if (width < scale * kLeastWidth || height < scale * kLeastHeight) continue;
      const auto all = areas(debug_layout(width, height, static_cast<float>(scale)));
      for (std::size_t i = 0; i < all.size(); ++i) {
        const UiArea& a = all[i].second;
        CAPTURE(all[i].first);
        CHECK(a.x >= 0.0f);
        CHECK(a.y >= 0.0f);
        CHECK(a.x + a.width <= static_cast<float>(width));
        CHECK(a.y + a.height <= static_cast<float>(height));
        CHECK(a.width >= 150.0f * static_cast<float>(scale));
        CHECK(a.height >= 30.0f * static_cast<float>(scale));
        for (std::size_t k = i + 1; k < all.size(); ++k) {
          const UiArea& b = all[k].second;
          CAPTURE(all[k].first);
          CHECK((a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y));
        }
      }
    }
  }
  CHECK(debug_scale(720) == 1);
  CHECK(debug_scale(1080) == 1);
  CHECK(debug_scale(1440) == 1);
  CHECK(debug_scale(2160) == 2);
  // a screen with four times the pixels has letters twice as high, and room for more
  const DebugLayout small = debug_layout(1280, 720, 1.0f), large = debug_layout(3840, 2160, 2.0f);
  for (const char* panel : {"contacts", "parameters", "timeline", "console"})
    CHECK(large.area(panel).height > 2.0f * 1.3f * small.area(panel).height);
}
