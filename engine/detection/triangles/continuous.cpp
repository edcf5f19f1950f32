// Hierarchies of boxes, and every motion looked at for surfaces that pass (step/motion_guard), not only those that are long
// for what they approach: where nothing may ever be let through, at the price of a search a pair and sub-step.
#include "engine/detection/triangles/narrow_phase.hpp"

namespace impinge {

Entry<NarrowPhase> bvh_narrow_phase();

namespace {

class ContinuousPhase final : public NarrowPhase {
 public:
  bool watches_every_motion() const override { return true; }
  void find(std::span<const Collider> colliders, std::span<const BodyPair> pairs,
            std::vector<TrianglePair>& found) override {
    trees_->find(colliders, pairs, found);
  }

 private:
  std::unique_ptr<NarrowPhase> trees_ = bvh_narrow_phase().make();
};

}  // namespace

Entry<NarrowPhase> continuous_narrow_phase() {
  return entry<NarrowPhase, ContinuousPhase>(
      "continuous", "As bvh, and narrow_phase.continuous = \"auto\" looks at every motion, however slow.");
}

}  // namespace impinge
