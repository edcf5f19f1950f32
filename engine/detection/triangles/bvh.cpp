// Two hierarchies over the triangles of two meshes, walked together from their roots [GottschalkLin96]: of flat discs
// (disc_pairs), or of boxes (box_pairs).
#include "engine/detection/triangles/box_pairs.hpp"
#include "engine/detection/triangles/disc_pairs.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"

namespace impinge {
namespace {

enum class Volume { disc, aabb, obb, sphere };

struct Settings {
  Volume volume = Volume::disc;
};

class Bvh final : public NarrowPhase {
 public:
  void declare(const Rows& rows) override {
    rows.add(
            "volume", settings_.volume,
            {{Volume::disc, "disc"}, {Volume::aabb, "aabb"}, {Volume::obb, "obb"}, {Volume::sphere, "sphere"}},
            "What a node is, and how two are told apart: flat discs that lie along the surface (disc), or boxes by the "
            "axes of one (aabb), by all separating axes (obb), by the spheres round them (sphere).")
        .formerly("narrow_phase.volume");
  }

  void find(std::span<const Collider> colliders, std::span<const BodyPair> pairs,
            std::vector<TrianglePair>& found) override {
    if (settings_.volume == Volume::disc) return discs_.find(colliders, pairs, found);
    const BoxTest how = settings_.volume == Volume::aabb  ? BoxTest::along_one
                        : settings_.volume == Volume::obb ? BoxTest::along_both
                                                          : BoxTest::by_spheres;
    boxes_.find(colliders, pairs, how, found);
  }

 private:
  Settings settings_;
  DiscPairs discs_;
  BoxPairs boxes_;
};

}  // namespace

Entry<NarrowPhase> bvh_narrow_phase() {
  return entry<NarrowPhase, Bvh>(
      "bvh", "Hierarchies of flat discs, or boxes, over the triangles, in the mesh's own frame if it is rigid.");
}

}  // namespace impinge
