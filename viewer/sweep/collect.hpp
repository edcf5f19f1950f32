// From the folders of a sweep's jobs to its table.
#pragma once

#include "viewer/sweep/plan.hpp"

namespace impinge {

/// Fills the rows' outcomes, figures, errors and own columns; returns the table's shape. Deterministic but for times.
SweepTable collect_sweep(const std::filesystem::path& out, Sweep& sweep, const SweepOptions& options,
                         const SweepBase& base);

/// What a reader of the errors has to know first: that the jobs were held against different methods. "" otherwise.
std::string reference_caution(const Sweep& sweep);

/// How the errors were taken, a line each: for the summary. "" without a reference.
std::string describe_errors(const Sweep& sweep, const SweepTable& table);

}  // namespace impinge
