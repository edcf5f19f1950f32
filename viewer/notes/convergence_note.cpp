#include "viewer/notes/convergence_note.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "viewer/notes/note_archive.hpp"

namespace impinge {
namespace {

constexpr double kRounding = 1e-7;  // relative to the contacts' velocities: an answer by any other name

std::string count(std::int64_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

std::string what_ended(const UnsolvedGroups& cause) {
  switch (cause.reason) {
    case SolveEnd::converged:
    case SolveEnd::fixed:
      break;
    case SolveEnd::cap:
      return "stopped at " + cause.limit;
    case SolveEnd::stalled:
      return "ended where more iterations bring nothing, or hardly anything";
    case SolveEnd::contradiction:
      return "had contacts that contradict each other";
    case SolveEnd::refused:
      return "were refused by lcp.method";
  }
  return "";
}

}  // namespace

void ConvergenceNote::add(const FrameStats& stats) {
  if (stats.merged_impacts > 0 && merged_ == 0) first_merged_ = stats.frame;
  merged_ += stats.merged_impacts;
  if (stats.unconverged == 0) return;
  is_worth_a_word_ |= !(stats.unsolved_residual < kRounding);
  for (const UnsolvedGroups& cause : stats.unsolved) count_unsolved(causes_, cause);
  solves_ += stats.unconverged;
  ++frames_;
  if (stats.residual > worst_) worst_ = stats.residual, worst_frame_ = stats.frame;
}

void ConvergenceNote::keep(NoteArchive& archive) {
  archive.list(causes_, [&](UnsolvedGroups& cause) { archive.keep(cause.reason, cause.limit, cause.solves); });
  archive.keep(solves_, frames_, worst_frame_, worst_, is_worth_a_word_, merged_, first_merged_);
}

std::string ConvergenceNote::impacts_text() const {
  if (merged_ == 0) return "";
  return fmt::format(
      "note:     in {} more impacts followed from one another than contact.successive_impacts tells "
      "apart, the first in frame {}: the rest were solved as one, which may lose energy or give it to others\n",
      count(merged_, "sub-step"), first_merged_);
}

std::string ConvergenceNote::text() const {
  if (!is_worth_a_word_) return impacts_text();
  std::string causes;
  if (causes_.size() == 1) {
    causes = what_ended(causes_.front());
  } else {
    causes = "did not converge: ";
    for (const UnsolvedGroups& cause : causes_)
      causes += fmt::format("{}{} {}", &cause == causes_.data() ? "" : ", ", cause.solves, what_ended(cause));
  }
  // the residual is that of the contacts, which a Newton scheme that ends at its cap has solved as they should be
  const bool are_roots = std::all_of(causes_.begin(), causes_.end(),
                                     [](const UnsolvedGroups& cause) { return cause.limit == kRootLimit; });
  const std::string left = are_roots
                               ? "motions don't balance their forces"
                               : fmt::format("the largest residual was {:.2g} m/s in frame {}", worst_, worst_frame_);
  return fmt::format("note:     {} in {} {}; {}\n", count(solves_, "group solve"), count(frames_, "frame"), causes,
                     left) +
         impacts_text();
}

}  // namespace impinge
