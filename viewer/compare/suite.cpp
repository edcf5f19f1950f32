#include "viewer/compare/suite.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <thread>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/core/parameter.hpp"
#include "engine/core/shell_word.hpp"
#include "engine/core/utf8.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/compare/picture_comparison.hpp"
#include "viewer/compare/suite_worker.hpp"
#include "viewer/controller/run.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/png_sequence.hpp"
#include "viewer/report/junit.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

std::string plural(std::size_t count, const char* word) {
  return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
}

struct Size {
  int width = 0, height = 0;
};

/// The size that the pictures of a test have. Throws InputError where two of them differ.
std::optional<Size> size_of(const std::vector<Script::ImageExpectation>& pictures) {
  std::optional<Size> size;
  fs::path first;
  for (const Script::ImageExpectation& picture : pictures) {
    if (!is_file(picture.file)) continue;
    const Image image = read_png(picture.file);
    if (size && (size->width != image.width || size->height != image.height))
      throw InputError(fmt::format(
          "{}: {} has {}x{} pixels; {}x{} as in {} are wanted; remove one of them and write it anew with --update",
          picture.place, picture.file.string(), image.width, image.height, size->width, size->height, first.string()));
    if (!size) size = Size{image.width, image.height}, first = picture.file;
  }
  return size;
}

class Suite {
 public:
  explicit Suite(const SuiteOptions& options) : options_(options), folder_(options.folder) {
    if (!is_folder(folder_))
      throw InputError(folder_.string() +
                       ": there is no such folder; a folder of NAME.toml and NAME.script is wanted; check the path");
    const fs::path named = absolute_path(folder_).lexically_normal();
    check_utf8_name(named.string());
    suite_ = (named.has_filename() ? named : named.parent_path()).filename().string();
    out_ = options.out.empty() ? fs::path("out") / (suite_ + "-test") : options.out;
    for (const fs::path name : names_in(folder_))
      if (name.extension() == ".script" && is_file(folder_ / name)) {
        check_utf8_name((folder_ / name).string());
        names_.insert(name.stem().string());
      }
    if (names_.empty())
      throw InputError(folder_.string() +
                       ": holds no script; NAME.toml with NAME.script beside it is wanted; see impinge test --help");
    options_.out = out_;
    if (!options.worker.empty()) return;  // the process that started this one has seen to the rest
    choose();
    make_folder(out_);
    lock_ = FolderLock::take(out_);
    // the outcome of a long suite must not be lost for want of a place
    if (!options.junit.empty()) write_file(options.junit, junit_xml(suite_, {}));
  }

  /// In a process for one test.
  int work() {
    belong_to_suite();
    SuiteResult result;
    result.outcome.name = options_.worker;
    try {
      result.outcome = run_one(options_.worker);
    } catch (const OutputError& error) {
      result.gave_up = error.what();
    }
    print_result(result);
    return 0;
  }

  int run() {
    std::vector<TestOutcome> outcomes;
    if (options_.jobs > 1)
      run_beside(outcomes);
    else
      run_in_turn(outcomes);
    if (!options_.junit.empty()) write_file(options_.junit, junit_xml(suite_, outcomes));
    const auto bad =
        std::count_if(outcomes.begin(), outcomes.end(), [](const TestOutcome& o) { return o.kind != TestOutcome::ok; });
    fmt::print("{}{}: {} ok, {} failed\n", plural(outcomes.size(), "test"),
               options_.only.empty() ? "" : fmt::format(" of {}", all_),
               static_cast<std::ptrdiff_t>(outcomes.size()) - bad, bad);
    return bad == 0 ? 0 : 1;
  }

 private:
  /// As --only names it.
  static std::string as_given(const std::string& name) {
    std::string text;
    for (const char c : name) text += c == ',' ? std::string("\\,") : std::string(1, c);
    return text;
  }
  /// Leaves the tests that are meant.
  void choose() {
    all_ = names_.size();
    if (options_.only.empty()) return;
    const std::vector<std::string> known(names_.begin(), names_.end());
    names_.clear();
    for (const std::string& name : options_.only) {
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        std::vector<std::string> written;
        for (const std::string& test : known) written.push_back(as_given(test));
        const std::string near = nearest_word(as_given(name), written);
        throw InputError(fmt::format("command line: --only names '{}'; tests of {}: {}; {}", name, folder_.string(),
                                     fmt::join(written, ", "),
                                     near.empty() ? "use some of them" : fmt::format("did you mean '{}'?", near)));
      }
      names_.insert(name);
    }
  }

  void run_in_turn(std::vector<TestOutcome>& outcomes) {
    for (const std::string& name : names_) {
      try {
        outcomes.push_back(run_one(name));
      } catch (const OutputError& error) {
        give_up(outcomes, name, error.what());
        throw;
      } catch (const Interrupted&) {
        give_up(outcomes, name, "interrupted");
        throw;
      }
      print(outcomes.back());
    }
  }

  /// Several at once, told in the order in which they would be run one after another.
  void run_beside(std::vector<TestOutcome>& outcomes) {
    setenv("LP_NUM_THREADS", "0", 1);  // the renderer paints in the run's own thread
    const std::vector<std::string> names(names_.begin(), names_.end());
    const int threads = std::max(1, thread_count() / options_.jobs);
    std::map<std::size_t, SuiteWorker> running;
    std::map<std::size_t, SuiteResult> ended;  // whose turn hasn't come
    bool goes_on = true;
    for (std::size_t next = 0; outcomes.size() < names.size();) {
      while (goes_on && next < names.size() && running.size() < static_cast<std::size_t>(options_.jobs)) {
        running.try_emplace(next, options_, names[next], threads);
        ++next;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      take_ended(running, [&](std::size_t place, SuiteResult result) {
        goes_on = goes_on && result.gave_up.empty();
        ended[place] = std::move(result);
      });
      while (ended.contains(outcomes.size())) tell(outcomes, ended.at(outcomes.size()));
      if (const auto* flag = InterruptScope::flag(); flag != nullptr && *flag) {
        stop(running);
        give_up(outcomes, names[outcomes.size()], "interrupted");
        throw Interrupted{};
      }
    }
  }
  static void take_ended(std::map<std::size_t, SuiteWorker>& running,
                         const std::function<void(std::size_t place, SuiteResult)>& take) {
    for (auto it = running.begin(); it != running.end();) {
      std::optional<SuiteResult> result = it->second.poll();
      if (result) take(it->first, std::move(*result));
      it = result ? running.erase(it) : std::next(it);
    }
  }
  void tell(std::vector<TestOutcome>& outcomes, SuiteResult& result) {
    if (!result.gave_up.empty()) {
      give_up(outcomes, result.outcome.name, result.gave_up);
      throw OutputError(result.gave_up);
    }
    outcomes.push_back(std::move(result.outcome));
    print(outcomes.back());
  }
  /// They have as long as a program has that is interrupted; what is left then is ended.
  static void stop(std::map<std::size_t, SuiteWorker>& running) {
    for (const auto& [place, worker] : running) worker.interrupt();
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(1100);
    while (!running.empty() && std::chrono::steady_clock::now() < end) {
      take_ended(running, [](std::size_t, const SuiteResult&) {});
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    running.clear();
  }

  /// No room for what a test writes is none for the next, and who interrupts one wants an end to all: the suite ends.
  /// Its XML must not pass for that of a good one.
  void give_up(std::vector<TestOutcome>& outcomes, const std::string& name, const std::string& reason) const {
    if (options_.junit.empty()) return;
    TestOutcome& last = outcomes.emplace_back();
    last.name = name, last.kind = TestOutcome::error;
    last.messages.push_back(reason + "; the tests after this one were not run");
    std::error_code error;
    try {
      write_file(options_.junit, junit_xml(suite_, outcomes));
    } catch (const OutputError&) {
      fs::remove(options_.junit, error);
    }
  }

  TestOutcome run_one(const std::string& name) {
    const auto start = std::chrono::steady_clock::now();
    TestOutcome outcome;
    outcome.name = name;
    try {
      test(outcome);
    } catch (const OutputError&) {
      throw;
    } catch (const InputError& error) {
      outcome.kind = TestOutcome::error;
      outcome.messages.push_back(error.what());
    } catch (const std::exception& error) {
      outcome.kind = TestOutcome::error;
      outcome.messages.push_back(std::string("a bug of impinge: ") + error.what());
    }
    outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return outcome;
  }

  void test(TestOutcome& outcome) {
    const fs::path scene = folder_ / (outcome.name + ".toml"), script = folder_ / (outcome.name + ".script");
    if (!is_file(scene))
      throw InputError(
          fmt::format("{}: has no scene {} beside it; every script of a suite has one; add it, or move the script",
                      script.string(), scene.filename().string()));
    RunOptions options;
    options.scene = scene;
    options.script = script;
    options.compares_pictures = false;
    std::vector<Script::ImageExpectation> pictures;
    {
      const Session session(scene, {}, script, {16, 9, false, true});
      pictures = session.script().images();
      outcome.expectations = static_cast<int>(session.script().expectations().size());
      options.frames = session.script().last_frame();
    }
    outcome.pictures = static_cast<int>(pictures.size());
    if (outcome.expectations + outcome.pictures == 0)
      throw InputError(script.string() +
                       ": expects nothing; at least one `expect` line is wanted; write expect contacts > 0 at 20");
    const Size size = size_of(pictures).value_or(Size{options_.width, options_.height});
    options.width = size.width, options.height = size.height;
    options.images = options.ids = !pictures.empty();
    options.out = out_ / outcome.name / "run";
    for (const char* last : {"run", "again"})
      if (const fs::path folder = out_ / outcome.name / last; is_file(folder / "run.toml")) {
        FolderLock::check_free(folder);
        std::error_code error;
        fs::remove_all(folder, error);
        if (error)
          throw OutputError(
              fmt::format("{}: can't be removed ({}); a folder that may be written to is wanted; choose "
                          "another --out",
                          folder.string(), error.message()));
      }

    RunWatcher watcher;
    watcher.message = [&](const std::string& line) { outcome.messages.push_back(line); };
    const RunResult result = impinge::run(options, watcher);
    if (result.interrupted) throw Interrupted{};
    if (!result.diverged.empty()) outcome.messages.push_back("diverged: " + result.diverged);
    if (result.exit_code() != 0) outcome.kind = TestOutcome::failed;
    check_pictures(outcome, pictures, options, result.last_frame);
    if (outcome.kind != TestOutcome::ok)
      outcome.messages.push_back(fmt::format("again: impinge run {} --script {} --frames {} --size {}x{} --out {}",
                                             shell_word(scene.string()), shell_word(script.string()), *options.frames,
                                             size.width, size.height,
                                             shell_word((out_ / outcome.name / "again").string())));
  }

  /// A baseline can't be written for two frames that look different: the second would take the first's place.
  static void refuse_doubled(const std::vector<Script::ImageExpectation>& pictures, const RunOptions& options,
                             int last_frame) {
    const auto made = [&](const Script::ImageExpectation& picture) {
      return options.out / "frames" / PngSequence::file_name(picture.frame);
    };
    for (std::size_t i = 0; i < pictures.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        const Script::ImageExpectation &second = pictures[i], &first = pictures[k];
        if (second.file.lexically_normal() != first.file.lexically_normal() ||
            std::max(first.frame, second.frame) > last_frame)
          continue;
        PictureRules rules;
        rules.settings.tolerance = second.tolerance;
        const std::string name = second.file.filename().string();
        if (compare_pictures(name, made(first), made(second), rules).verdict == PictureComparison::same) continue;
        throw InputError(
            fmt::format("{}: {} at frame {}, and at frame {} ({}), which looks different; a picture of its "
                        "own for each is wanted; name another file",
                        second.place, name, second.frame, first.frame, first.place));
      }
  }

  void check_pictures(TestOutcome& outcome, const std::vector<Script::ImageExpectation>& pictures,
                      const RunOptions& options, int last_frame) {
    const fs::path shown = out_ / outcome.name;
    std::error_code error;
    fs::remove(shown / "report.html", error);  // of the last time
    std::vector<std::string> failures;
    if (outcome.kind == TestOutcome::failed) failures = outcome.messages;
    if (options_.update) refuse_doubled(pictures, options, last_frame);
    std::vector<PictureComparison> all;
    for (const Script::ImageExpectation& picture : pictures) {
      if (picture.frame > last_frame) {
        outcome.kind = TestOutcome::failed;
        outcome.messages.push_back(fmt::format("{}: frame {} was not reached", picture.place, picture.frame));
        continue;
      }
      const fs::path made = options.out / "frames" / PngSequence::file_name(picture.frame),
                     baseline = baseline_for(picture.file, made);
      PictureRules rules;
      rules.settings.tolerance = picture.tolerance;
      PictureComparison c;
      if (is_file(baseline)) {
        c = compare_pictures(baseline.filename().string(), baseline, made, rules);
      } else {
        c.name = picture.file.filename().string();
        c.b = made;
        c.verdict = PictureComparison::missing_in_a;
        c.headline = fmt::format("there is no {}; impinge test {} --update writes it", picture.file.string(),
                                 shell_word(folder_.string()));
      }
      if (c.verdict == PictureComparison::same) {
        if (!options_.update) continue;
        if (const fs::path ids = update_ids(c); !ids.empty())
          outcome.messages.push_back(
              fmt::format("wrote the ids {}; the picture is the same within the limits, and kept", ids.string()));
        continue;
      }
      if (options_.update) {
        const bool is_new = c.a.empty();
        const fs::path target = is_new ? picture.file : c.a, written = update_baseline(c, target, made);
        outcome.messages.push_back(fmt::format("{} {}{}",
                                               is_new              ? "new:"
                                               : written == target ? "rewrote"
                                                                   : "wrote the alternate",
                                               written.string(), is_new ? "" : ": " + c.headline));
        continue;
      }
      outcome.kind = TestOutcome::failed;
      outcome.messages.push_back(fmt::format("{}: frame {}: {}: {}", picture.place, picture.frame, c.name, c.headline));
      for (const std::string& line : c.details) outcome.messages.push_back("  " + line);
      all.push_back(std::move(c));
    }
    if (all.empty() && failures.empty()) return;
    write_picture_report(shown, all.empty() ? outcome.name : outcome.name + ": A is wanted, B was drawn", all, {},
                         failures);
    outcome.messages.push_back(fmt::format("see:   {}", (shown / "report.html").string()));
  }

  static void print(const TestOutcome& o) {
    const char* word = o.kind == TestOutcome::ok ? "ok    " : o.kind == TestOutcome::failed ? "FAILED" : "ERROR ";
    fmt::print("{}  {}: {}, {} ({:.1f} s)\n", word, o.name,
               plural(static_cast<std::size_t>(o.expectations), "expectation"),
               plural(static_cast<std::size_t>(o.pictures), "picture"), o.seconds);
    for (const std::string& line : o.messages) fmt::print("        {}\n", line);
    std::fflush(stdout);
  }

  SuiteOptions options_;
  fs::path folder_, out_;
  FolderLock lock_;  // of out_
  std::string suite_;
  std::set<std::string> names_;
  std::size_t all_ = 0;  // tests that the folder has
};

}  // namespace

int run_suite(const SuiteOptions& options) {
  Suite suite(options);
  return options.worker.empty() ? suite.run() : suite.work();
}

}  // namespace impinge
