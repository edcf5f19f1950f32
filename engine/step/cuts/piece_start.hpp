// Where a piece of a sub-step begins: a motion that turns out to lead through something is taken back to it.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "engine/bodies/bodies.hpp"
#include "engine/core/archive.hpp"
#include "engine/step/sleeping.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

/// The active bodies one by one. Who wakes later stands until then as he was published.
class PieceStart {
 public:
  using Published = std::function<std::string_view(BodyIndex)>;  ///< what Body::save wrote
  PieceStart(const Bodies& bodies, const Sleeping& sleeping, Published published);
  void bring_back(Bodies& bodies, Sleeping& sleeping) const;
  /// The same after a motion, which leaves its impulses to the one that is made instead: they are much alike.
  void take_back(SubStep& step, Bodies& bodies, Sleeping& sleeping) const;
  /// The body where it stood, as it is otherwise.
  void let_stay(Body& body, BodyIndex index) const;

 private:
  std::string_view of(BodyIndex body) const;

  std::vector<BodyIndex> active_;
  Sleeping sleeping_;
  Published published_;
  ByteWriter out_;
  std::vector<std::size_t> begin_;  // by active body
};

}  // namespace impinge
