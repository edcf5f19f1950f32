// The command line as data. One place knows the parser; sub-commands get their own struct.
#pragma once

#include <string>
#include <vector>

#include "viewer/controller/run.hpp"
#include "viewer/sweep/options.hpp"

namespace impinge {

struct Arguments {
  enum Kind { run, replay, diff, check, info, list, step, sweep, test, compare, debug, print };
  Kind kind = print;
  std::string text;        ///< of print: help or version
  RunOptions run_options;  ///< run; check and info use scene and overrides
  std::string video;       ///< run: file, "" for none
  int threads = 0;         ///< 0: as many as the machine has cores
  bool quiet = false;
  /// diff, compare: the two sides; replay, test: a is the folder; list: a is the topic; step: a is the file
  std::string a, b;
  std::string out, mask;                  ///< diff; step, test, compare: out
  std::string junit;                      ///< test: file, "" for none
  bool update = false;                    ///< diff, test: rewrite baselines
  int tolerance = 3;                      ///< diff, compare, of 255
  std::vector<std::string> responses;     ///< step: names, empty for all
  std::vector<std::string> lcp;           ///< step: names of solvers, empty for all
  double step_tolerance = 1e-8;           ///< step: relative residual
  int max_iterations = 2000;              ///< step
  std::string record;                     ///< debug: file, "" for none
  bool window = false, headless = false;  ///< debug
  int scale = 0;                          ///< debug: of text; 0: by the height
  int memory = 256;                       ///< debug: megabytes
  SweepOptions sweep_options;             ///< sweep
  bool ablation = false;                  ///< info; `out` is the folder for ablation.csv, "" for none
};

/// Throws InputError with one message about the first thing that is wrong.
Arguments parse_arguments(int count, const char* const* words);

}  // namespace impinge
