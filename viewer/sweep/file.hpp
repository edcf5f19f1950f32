// A sweep written down: the table [sweep] of a scene file, or of a file of its own that names its scene.
#pragma once

#include "viewer/controller/run.hpp"
#include "viewer/sweep/options.hpp"

namespace impinge {

/// Takes what the [sweep] table of `run.scene` says and the command line doesn't, key by key; the scene becomes the one
/// it names. A file without the table changes nothing. Throws InputError at the place of what is
/// wrong.
void read_sweep_file(SweepOptions& sweep, RunOptions& run);

/// The whole as such a file: what tells a sweep from another in the same folder.
std::string format_sweep_file(const SweepOptions& sweep, const RunOptions& options);

}  // namespace impinge
