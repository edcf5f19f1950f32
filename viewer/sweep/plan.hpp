// What a sweep will run and put side by side, checked before anything is written.
#pragma once

#include "viewer/sweep/columns.hpp"
#include "viewer/sweep/table.hpp"
#include "viewer/sweep/values.hpp"

namespace impinge {

/// What errors are against.
enum class SweepReferenceKind { none, settings, finest, analytic };

struct Sweep {
  std::vector<SweepAxis> axes;
  std::vector<std::string> paths;  ///< of the axes
  std::vector<SweepRow> rows;      ///< without figures; in the order of the values, whatever runs first
  /// what to run, in that order: references before the jobs they serve, each hash once
  std::vector<SweepJob> jobs;
  SweepReferenceKind reference = SweepReferenceKind::none;
  std::vector<std::string> reference_words;  ///< PATH=VALUE, or PATH=finest, or case:NAME
  std::string analytic_case;                 ///< NAME
  /// the varied methods that references have, PATH=VALUE, each once; fewer than two: all jobs have one truth
  std::vector<std::string> reference_methods;
  double window = -1.0;  ///< seconds; -1: automatic; infinite: all
  SweepColumns columns;  ///< the user's
};

/// `options` are the run's, complete. Throws InputError.
Sweep plan_sweep(const SweepOptions& sweep, const RunOptions& options, const SweepBase& base);

}  // namespace impinge
