// What a scene's economies are worth: run as it is, and with each of them switched off.
#pragma once

#include "viewer/controller/run.hpp"

namespace impinge {

/// Something that is left out, and the settings that put it back.
struct Economy {
  std::string name;  ///< "sleeping"
  /// what is modelled without it; of one that can't be switched off: what it leaves out
  std::string instead;
  std::vector<std::string> overrides;  ///< PATH=VALUE; empty: always there, or nothing in the scene has a use for it
  std::string without;                 ///< "always" or "no use here" where there are no settings
};

/// Every economy, those first that can be switched off in this scene.
std::vector<Economy> economies(const Session& session);

struct AblationRow {
  Economy economy;
  int frames = 0;  ///< of simulation that were made in the time given
  /// processor time, mean over frames, of each the smallest of up to three runs; -1: not run
  double frame_ms = -1.0;
  double ratio = -1.0;       ///< to the scene as it is, over the same frames
  double difference = -1.0;  ///< largest distance of a body, in sizes of the scene; -1: not run
  std::string ended;         ///< why it ended early, "" if it didn't
};

/// Runs to `last_frame`; a setting that takes more than ten times as long as the scene as it is (and 5 s) ends early
/// and is compared over the frames that it has made. The distance of a body is the root of the mean square over the
/// points of its surface, the size of the scene the diagonal of the box round all bodies that can move at frame 0. The
/// first row is the scene as it is, the second the same once more, which shows the noise of the timings; the last that
/// is run has all economies off at once but those that ended early.
std::vector<AblationRow> ablate(const RunOptions& options, int last_frame,
                                const std::function<void(const AblationRow&)>& ready);

/// Throws InputError if there is nothing to run.
void check_ablation(const RunOptions& options, const Session& session);

/// Prints the table of ablate() as it comes; with a folder writes ablation.csv there too. Throws InputError.
void print_ablation(const RunOptions& options, const std::filesystem::path& out);

}  // namespace impinge
