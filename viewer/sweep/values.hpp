// The values that a sweep goes through: `--vary PATH=SPEC` as a list, and lists as jobs.
#pragma once

#include "viewer/controller/session.hpp"
#include "viewer/sweep/options.hpp"

namespace impinge {

struct SweepAxis {
  std::string path;
  std::vector<std::string> values;  ///< each in the form that --set takes, no two alike
};

/// SPEC is a,b,c | lo:hi:n (evenly spaced, both ends) | log(lo,hi,n) (evenly in the logarithm). Values of a parameter
/// are checked against its row, in `session`; a key of a body that has no row by loading the scene with it, through
/// `load`. Throws InputError beginning with the setting's place, or `option` and the text.
SweepAxis read_sweep_axis(const char* option, const SweepSetting& setting, const Session& session,
                          const std::function<void(const std::string& override_text)>& load);

/// Whether all values are numbers.
bool is_numeric(const SweepAxis& axis);

/// How many jobs: the product, or with `zip` the common length. Throws InputError for axes that share a path, lists of
/// different lengths under `zip`, and more jobs than `most`; `settings` are those of the axes, for the places.
std::size_t count_sweep_jobs(const std::vector<SweepAxis>& axes, const std::vector<SweepSetting>& settings, bool zip,
                             std::size_t most);

/// The values of one job, an axis each; the first axis changes slowest.
std::vector<std::string> sweep_job_values(const std::vector<SweepAxis>& axes, bool zip, std::size_t job);

/// How early a job comes when coarse pictures come first: 0 where every number stands at an end of its range, 1 where
/// at an end or in the middle, 2 with the quarters, ... Values that are no numbers are all ends.
int sweep_job_level(const std::vector<SweepAxis>& axes, bool zip, std::size_t job);

}  // namespace impinge
