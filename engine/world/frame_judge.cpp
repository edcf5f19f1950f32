#include "engine/world/frame_judge.hpp"

#include <algorithm>

#include "engine/world/self_crossings.hpp"

namespace impinge {

void FrameJudge::add(const Bodies& bodies, int substep) {
  OverlapVerdict now = judge_overlap(bodies, memory_);
  now.crossing.substep = substep;
  worst_.penetration = std::max(worst_.penetration, now.penetration);
  worst_.deepest = std::max(worst_.deepest, now.deepest);
  worst_.intersections = std::max(worst_.intersections, now.intersections);
  if (now.crossing.share() > worst_.crossing.share()) worst_.crossing = now.crossing;
  self_crossings_ = std::max(self_crossings_, count_self_crossings(bodies));
  has_looked_ = true;
}

void FrameJudge::finished(const Bodies& bodies, int substep) {
  if (when_ == each_substep) add(bodies, substep);
}

void FrameJudge::judge(const Bodies& bodies, FrameStats& stats) {
  if (!has_looked_) add(bodies, 0);
  stats.judged_penetration = worst_.penetration;
  stats.judged_depth = worst_.deepest;
  stats.judged_intersections = worst_.intersections;
  stats.crossing = worst_.crossing;
  stats.self_crossings = std::max(stats.self_crossings, self_crossings_);
  worst_ = {};
  self_crossings_ = 0;
  has_looked_ = false;
}

}  // namespace impinge
