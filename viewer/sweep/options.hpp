// What a sweep is asked to do, by the command line or by a [sweep] table; every text knows where it stands.
#pragma once

#include <string>
#include <vector>

namespace impinge {

/// One text of the user's. `place` is "file:line:column", or "" for the command line.
struct SweepSetting {
  std::string text;
  std::string place = {};
  /// of an array in a file: the values themselves; `text` then is PATH=all of them
  std::vector<std::string> values = {};

  /// For messages: the place, or the option with its text.
  std::string where(const char* option) const { return place.empty() ? std::string(option) + " " + text : place; }
};

struct SweepOptions {
  std::vector<SweepSetting> vary;       ///< PATH=SPEC
  std::vector<SweepSetting> reference;  ///< PATH=VALUE each, or one of `finest`, `case:NAME`; empty for no errors
  std::vector<SweepSetting> columns;    ///< NAME=EXPR
  SweepSetting filter;                  ///< text "" for none
  SweepSetting window;                  ///< seconds, `all` or `automatic`; text "" means automatic
  std::string engine = "local";
  std::vector<std::string> jobs_alone;  ///< --job: hashes of the only jobs to run, empty for all
  int jobs = 0;                         ///< at once; 0: as many as there are cores, or as Slurm gives
  int repeat = 0;                       ///< runs of each job; 0: not said, one
  bool zip = false, coarse_first = false, yes = false;
  bool size_given = false;  ///< on the command line
  int repeats() const { return repeat > 0 ? repeat : 1; }
};

}  // namespace impinge
