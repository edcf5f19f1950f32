// A body that never moves.
#pragma once

#include "engine/bodies/body.hpp"

namespace impinge {

class FixedBody final : public Body {
 public:
  BodyKind kind() const override { return BodyKind::fixed; }
  void save(ByteWriter& out) const override { save_frame(out, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()); }
  void restore(ByteReader& in) override { restore_frame(in); }
};

}  // namespace impinge
