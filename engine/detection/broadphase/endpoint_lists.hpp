// The incremental half of sweep and prune [Haapaoja16 §3.1]: three sorted lists of box ends, kept from frame to frame
// and sorted again by insertion. Every change of the overlap set shows as a swap of one box's lower end with another's
// upper end, so n boxes with s swaps cost O(n + s).
#pragma once

#include <span>

#include "engine/detection/broadphase/broad_phase.hpp"

namespace impinge {

class EndpointLists {
 public:
  /// Sorts the lists anew, O(n log n).
  void build(std::span<const Aabb> boxes);
  /// Moves the ends from `before` to `now` (as many boxes) and lists the pairs that began and ceased to overlap, sorted
  /// and unique. Gives up and returns false when more than `max_swaps` swaps are needed: then the lists must be built
  /// anew. [Haapaoja16 fig. 3.2: turning every end round costs n² swaps.]
  bool update(std::span<const Aabb> before, std::span<const Aabb> now, std::size_t max_swaps);

  const std::vector<BoxPair>& begun() const { return begun_; }
  const std::vector<BoxPair>& ceased() const { return ceased_; }
  std::size_t swaps() const { return swaps_; }  ///< of the last update

 private:
  struct Endpoint {
    double value;
    std::uint32_t key;  ///< 2 · box + (upper end ? 1 : 0)
  };
  /// Touching boxes overlap, so lower ends come before upper ends of the same value.
  static bool before(const Endpoint& l, const Endpoint& r) {
    return l.value < r.value || (l.value == r.value && (l.key & 1u) < (r.key & 1u));
  }
  bool update_axis(int axis, std::span<const Aabb> before, std::span<const Aabb> now, std::size_t max_swaps);

  std::array<std::vector<Endpoint>, 3> lists_;
  std::vector<BoxPair> begun_, ceased_;
  std::size_t swaps_ = 0;
};

}  // namespace impinge
