#include "viewer/controller/breakpoints.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/world/figures.hpp"

namespace impinge {

void Breakpoints::read_again(const ExpressionWords& words) {
  static const std::string kBreak = "break";
  for (Breakpoint& point : points_) {
    const std::string text = point.condition.text();
    point.condition = Expression({text, &kBreak, 1, 1}, words);
  }
}

void Breakpoints::recorded(Bodies& bodies, const StepRecord& so_far, int substep, int) {
  if (substep == 1) forget_begun();
  std::vector<double> figures = figure_values(so_far.stats, judged_);
  for (std::size_t i = 0; judged_ && i < figures.size(); ++i)
    if (find_figure(figure_names(true)[i])->kind == FigureKind::judged) figures[i] = NAN;
  std::vector<bool>& now = begun_.emplace_back();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::vector<double>& values = values_[{substep, i}] =
        reader_.values(points_[i].condition, figures, so_far, bodies);
    now.push_back(points_[i].condition.holds(values));
  }
}

void Breakpoints::end(int frame, std::span<const double> figures, const StepRecord& record, Bodies& bodies) {
  const int substeps = static_cast<int>(begun_.size()) + 1;
  if (substeps == 1) values_.clear();
  values_frame_ = frame;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    std::vector<bool>& held = points_[i].held[frame];
    held.clear();
    for (const std::vector<bool>& substep : begun_) held.push_back(substep[i]);
    const std::vector<double>& values = values_[{substeps, i}] =
        reader_.values(points_[i].condition, figures, record, bodies);
    held.push_back(points_[i].condition.holds(values));
  }
  begun_.clear();
}

std::optional<BreakHit> Breakpoints::look_at_last(int frame, int substep, const std::vector<double>& values) {
  Breakpoint& point = points_.back();
  const bool holds = point.condition.holds(values);
  point.first = Breakpoint::Look{frame, substep, holds};
  if (!holds) return std::nullopt;
  return BreakHit{1, 1, points_.size() - 1, values};
}

bool Breakpoints::know(int frame) const {
  for (const Breakpoint& point : points_)
    if (!point.held.contains(frame)) return false;
  return true;
}

bool Breakpoints::held(const Breakpoint& point, int frame, int substep) const {
  const auto seen = [&](int at_frame, int at_substep) {
    return point.first && point.first->frame == at_frame && point.first->substep == at_substep && point.first->held;
  };
  if (substep == 0) {  // the end of the frame before
    const auto before = point.held.find(frame - 1);
    return before != point.held.end() ? before->second.back() : seen(frame - 1, 0);
  }
  const auto it = point.held.find(frame);
  return it != point.held.end() ? it->second[static_cast<std::size_t>(substep) - 1] : seen(frame, substep);
}

std::optional<BreakHit> Breakpoints::next(int frame, int after) const {
  std::optional<BreakHit> first;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto it = points_[i].held.find(frame);
    if (it == points_[i].held.end()) continue;
    const int substeps = static_cast<int>(it->second.size());
    for (int s = after + 1; s <= substeps; ++s) {
      if (!held(points_[i], frame, s) || held(points_[i], frame, s - 1)) continue;
      if (!first || s < first->substep) first = BreakHit{s, substeps, i, {}};
      break;
    }
  }
  if (first && values_frame_ == frame)
    if (const auto it = values_.find({first->substep, first->point}); it != values_.end()) first->values = it->second;
  return first;
}

std::string Breakpoints::tell(int frame, const BreakHit& hit) {
  Breakpoint& point = points_[hit.point];
  std::string text = fmt::format("{}: frame {}: stopped by break when {}", point.place, frame, point.condition.text());
  if (!hit.is_end()) text += fmt::format(", sub-step {} of {}", hit.substep, hit.substeps);
  if (!hit.values.empty()) text += "; " + point.condition.describe(hit.values, figure_names(judged_));
  if (++point.hits > 1) text += fmt::format("; hit {}", point.hits);
  return text;
}

void Breakpoints::forget_before(int frame) {
  for (Breakpoint& point : points_) point.held.erase(point.held.begin(), point.held.lower_bound(frame));
}

void Breakpoints::cut(int frame) {
  for (Breakpoint& point : points_) point.held.erase(point.held.lower_bound(frame), point.held.end());
}

}  // namespace impinge
