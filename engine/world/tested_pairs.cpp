#include "engine/world/tested_pairs.hpp"

#include <array>

namespace impinge {

std::optional<std::pair<int, int>> first_untested_pair(
    std::span<const RigidBody> bodies, const std::function<bool(const Shape&, const Shape&)>& has_test) {
  constexpr std::size_t kKinds = std::variant_size_v<Shape>;
  const int count = static_cast<int>(bodies.size());
  std::array<int, kKinds> last, last_free;  // body of each kind that stands last in the scene
  last.fill(-1);
  last_free.fill(-1);
  for (int i = 0; i < count; ++i) {
    const std::size_t kind = bodies[i].shape.index();
    last[kind] = i;
    if (bodies[i].has_freedom()) last_free[kind] = i;
  }
  std::array<std::array<bool, kKinds>, kKinds> tested{};
  for (std::size_t k = 0; k < kKinds; ++k)
    for (std::size_t l = 0; l < kKinds; ++l)
      tested[k][l] = last[k] < 0 || last[l] < 0 || has_test(bodies[last[k]].shape, bodies[last[l]].shape);

  for (int i = 0; i < count; ++i) {
    const auto& is_tested = tested[bodies[i].shape.index()];
    const bool is_free = bodies[i].has_freedom();
    const auto meets_untested = [&](int j) {
      return !is_tested[bodies[j].shape.index()] && (is_free || bodies[j].has_freedom());
    };
    bool found = false;
    for (std::size_t l = 0; l < kKinds; ++l) found |= !is_tested[l] && (is_free ? last[l] : last_free[l]) > i;
    for (int j = i + 1; found && j < count; ++j)
      if (meets_untested(j)) return std::pair(i, j);
  }
  return std::nullopt;
}

}  // namespace impinge
