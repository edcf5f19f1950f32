// impinge replay
#include <fmt/format.h>

#include "engine/core/archive.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/app/shared_options.hpp"
#include "viewer/bundle/bundle.hpp"
#include "viewer/controller/session.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {

namespace {

/// Returns the exit code. `name` is what the run is called.
int replay(const std::filesystem::path& folder, const std::string& name) {
  if (!is_there(folder))
    throw InputError(
        name +
        ": there is no such file or folder; the --out of an impinge run, or a bundle, is wanted; check the "
        "path");
  if (!is_file(folder / "run.toml"))
    throw InputError(folder.string() +
                     ": holds no run.toml; the folder of a run, or a bundle, is wanted; name the --out of an impinge "
                     "run");
  const std::string table = read_file(folder / "stats.csv", std::uint64_t{64} << 30);
  Session session(folder / "run.toml", {}, {});
  if (!session.scene().run)
    throw InputError((folder / "run.toml").string() +
                     ": has no table [run]; a file that a run wrote is wanted; name the --out of an impinge run");

  int frames = 0, different = 0;
  const std::string file = (folder / "stats.csv").string();
  StatsReader reader(table, session.stats_shape(), file);
  for (StatsLine row; reader.next(row);) {
    session.advance();
    const std::string hash = hex64(session.record().stats.state_hash);
    if (row.figures[0] != session.frame())
      throw InputError(fmt::format("{}: row {} is of frame {}; rows in order are wanted; run the scene again",
                                   (folder / "stats.csv").string(), frames, row.figures[0]));
    if (hash != row.state_hash && different++ == 0)
      fmt::print("frame {}: state hash {}, recorded {}\n", session.frame(), hash, row.state_hash);
    ++frames;
  }
  if (frames == 0)
    throw InputError((folder / "stats.csv").string() +
                     ": has no frames; a recorded run is wanted; run the scene first");
  if (different > 0) {
    fmt::print("{}: {} of {} frames differ\n", name, different, frames);
    if (session.scene().run->version != IMPINGE_VERSION)
      fmt::print("it was recorded by version {}, this is {}\n", session.scene().run->version, IMPINGE_VERSION);
    return 1;
  }
  const int due = session.scene().run->frames;
  if (session.frame() < due && is_there(folder / "done"))
    throw InputError(
        fmt::format("{}: ends with frame {}, but the run came to its end, frame {}; the whole table is wanted; "
                    "run the scene again",
                    file, session.frame(), due));
  fmt::print("{}: {} frames repeated, every state hash is the recorded one\n", name, frames);
  if (session.frame() < due && folder == name) fmt::print("the run was to go on to frame {}\n", due);
  return 0;
}

class ReplayCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("DIR", run_, "folder of the run, or a bundle of the debugger");
    memory_option(options);
    threads_option(options);
  }
  int run() override {
    if (!is_bundle(run_)) return replay(run_, run_.string());
    const UnpackedBundle bundle(run_);
    return replay(bundle.folder(), run_.string());
  }

 private:
  std::filesystem::path run_;
};

}  // namespace

Entry<SubCommand> replay_command() {
  return entry<SubCommand, ReplayCommand>("replay", "repeat a recorded run and check every state hash");
}

}  // namespace impinge
