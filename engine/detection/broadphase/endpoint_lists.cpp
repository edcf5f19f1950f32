#include "engine/detection/broadphase/endpoint_lists.hpp"

#include <algorithm>

namespace impinge {
namespace {

BoxPair ordered(std::uint32_t i, std::uint32_t j) {
  return {static_cast<int>(std::min(i, j)), static_cast<int>(std::max(i, j))};
}

void sort_unique(std::vector<BoxPair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace

void EndpointLists::build(std::span<const Aabb> boxes) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Endpoint>& list = lists_[axis];
    list.resize(2 * boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      list[2 * i] = {boxes[i].min[axis], static_cast<std::uint32_t>(2 * i)};
      list[2 * i + 1] = {boxes[i].max[axis], static_cast<std::uint32_t>(2 * i + 1)};
    }
    std::sort(list.begin(), list.end(), [](const Endpoint& l, const Endpoint& r) {
      return EndpointLists::before(l, r) || (!EndpointLists::before(r, l) && l.key < r.key);
    });
  }
}

bool EndpointLists::update_axis(int axis, std::span<const Aabb> before, std::span<const Aabb> now,
                                std::size_t max_swaps) {
  std::vector<Endpoint>& list = lists_[axis];
  for (std::size_t i = 0; i < list.size(); ++i) {
    Endpoint moving = list[i];
    const std::uint32_t box = moving.key >> 1;
    const bool upper = moving.key & 1u;
    moving.value = upper ? now[box].max[axis] : now[box].min[axis];
    std::size_t j = i;
    for (; j > 0 && EndpointLists::before(moving, list[j - 1]); --j) {
      const Endpoint& passed = list[j - 1];
      // an inner pair of ends swaps at most once, so a swap tells what holds at the end of the pass on this axis; the
      // two boxes themselves tell about the other axes
      if ((passed.key ^ moving.key) & 1u) {
        const std::uint32_t other = passed.key >> 1;
        if (upper) {
          if (overlap(before[box], before[other])) ceased_.push_back(ordered(box, other));
        } else if (overlap(now[box], now[other])) {
          begun_.push_back(ordered(box, other));
        }
      }
      list[j] = passed;
    }
    list[j] = moving;
    swaps_ += i - j;
    if (swaps_ > max_swaps) return false;
  }
  return true;
}

bool EndpointLists::update(std::span<const Aabb> before, std::span<const Aabb> now, std::size_t max_swaps) {
  begun_.clear();
  ceased_.clear();
  swaps_ = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (!update_axis(axis, before, now, max_swaps)) return false;
  sort_unique(begun_);
  sort_unique(ceased_);
  return true;
}

}  // namespace impinge
