#include "engine/step/cuts/piece_start.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "engine/step/remember.hpp"

namespace impinge {

PieceStart::PieceStart(const Bodies& bodies, const Sleeping& sleeping, Published published)
    : active_(bodies.active().begin(), bodies.active().end()), sleeping_(sleeping), published_(std::move(published)) {
  for (const BodyIndex b : active_) begin_.push_back(out_.bytes().size()), bodies[b].save(out_);
}

void PieceStart::bring_back(Bodies& bodies, Sleeping& sleeping) const {
  for (const BodyIndex b : bodies.active()) {
    ByteReader in(of(b));
    bodies[b].restore(in), bodies[b].update_world_vertices();
  }
  sleeping = sleeping_;
}

void PieceStart::take_back(SubStep& step, Bodies& bodies, Sleeping& sleeping) const {
  step.tried = impulses_of(step.results);
  bring_back(bodies, sleeping);
}

void PieceStart::let_stay(Body& body, BodyIndex index) const {
  ByteReader in(of(index));
  const auto sleep = std::tuple(body.asleep, body.rest_time, body.island);
  body.stay(in), body.update_world_vertices();
  std::tie(body.asleep, body.rest_time, body.island) = sleep;
}

std::string_view PieceStart::of(BodyIndex body) const {
  const auto at = std::lower_bound(active_.begin(), active_.end(), body);
  if (at == active_.end() || *at != body) return published_(body);
  return std::string_view(out_.bytes()).substr(begin_[static_cast<std::size_t>(at - active_.begin())]);
}

}  // namespace impinge
