// impinge shrink
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "engine/io/paths.hpp"
#include "viewer/app/shared_options.hpp"
#include "viewer/controller/interrupt.hpp"
#include "viewer/shrink/shrink.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

/// One line on a terminal.
class ShrinkLine {
 public:
  void show(const ShrinkProgress& p) {
    const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    const auto s = [](auto count) { return count == 1 ? "" : "s"; };
    fmt::print(stderr, "\r{}: {} bod{}, {} frame{}, {} command{}, {} triangle{}; {} scene{} tried{}\x1b[K", p.at,
               p.size.bodies, p.size.bodies == 1 ? "y" : "ies", p.size.frames, s(p.size.frames), p.size.commands,
               s(p.size.commands), p.size.triangles, s(p.size.triangles), p.tried, s(p.tried),
               p.tried > 1 ? fmt::format("  about {:.0f} s left", seconds / p.tried * p.left) : "");
    std::fflush(stderr);
  }
  void clear() const { fmt::print(stderr, "\r\x1b[K"); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

class ShrinkCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("BUNDLE", shrink_.bundle, "bundle of the debugger (its line `bundle FILE.tar`)");
    options.text("--when", shrink_.condition,
                 "condition that must still come true, as after `break when`: figures, depth(A,B), speed(A), ...");
    options.path("--out", shrink_.out, "the small bundle (default: BUNDLE's name with _small)");
    quiet_option(options, quiet_);
    memory_option(options);
    threads_option(options);
  }

  int run() override {
    check();
    explain_interrupt("the smallest bundle by now is kept");
    ShrinkLine line;
    const bool shows = !quiet_ && isatty(STDERR_FILENO) == 1;
    const ShrinkResult result = shrink(shrink_, [&](const ShrinkProgress& p) {
      if (shows) line.show(p);
    });
    if (shows) line.clear();
    if (!quiet_) print(result);
    return result.interrupted ? 130 : 0;
  }

 private:
  void check() {
    if (shrink_.condition.empty())
      refuse_option("shrink without --when", "a condition is wanted", "write --when 'max_penetration_m > 0.01'");
    if (is_folder(shrink_.bundle))
      throw InputError(shrink_.bundle.string() +
                       ": is a folder; a bundle is wanted; open it by impinge debug and write `bundle FILE.tar`");
    if (shrink_.out.empty())
      shrink_.out = shrink_.bundle.parent_path() / (shrink_.bundle.stem().string() + "_small.tar");
    std::error_code error;
    if (fs::equivalent(shrink_.out, shrink_.bundle, error))
      refuse_option(fmt::format("--out is the bundle itself, {}", shrink_.out.string()), "another file is wanted",
                    "choose one");
    if (is_there(shrink_.out) && !is_bundle(shrink_.out))
      refuse_option(fmt::format("--out is {}, which is there and no bundle", shrink_.out.string()),
                    "a new file is wanted", "choose another or remove it");
  }

  void print(const ShrinkResult& result) const {
    const SceneSize &a = result.before, &b = result.after;
    const auto line = [](const char* what, std::size_t before, std::size_t after) {
      if (before > 0) fmt::print("{:<12} {:>8} -> {}\n", what, before, after);
    };
    line("bodies", a.bodies, b.bodies);
    line("attachments", a.attachments, b.attachments);
    line("frames", static_cast<std::size_t>(a.frames), static_cast<std::size_t>(b.frames));
    line("commands", a.commands, b.commands);
    line("triangles", a.triangles, b.triangles);
    for (const std::string& note : result.notes) fmt::print("note: {}\n", note);
    fmt::print("{}: {} after {} scenes\n", shrink_.out.string(),
               result.interrupted ? "the smallest until it was interrupted," : "nothing more can go,", result.tried);
  }

  ShrinkOptions shrink_;
  bool quiet_ = false;
};

}  // namespace

Entry<SubCommand> shrink_command() {
  return entry<SubCommand, ShrinkCommand>(
      "shrink", "make a bundle small: take out what isn't needed for a condition to come true");
}

}  // namespace impinge
