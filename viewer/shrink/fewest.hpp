// The fewest of many that still do: delta debugging [Zeller02].
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

namespace impinge {

/// A part of `items`, in their order, for which `holds` is true and of which no single one can be left out. `holds` is
/// true of all of them, and is asked of the same parts in the same order each time.
template <class T>
std::vector<T> fewest(std::vector<T> items, const std::function<bool(const std::vector<T>&)>& holds) {
  if (items.empty() || holds({})) return {};
  for (std::size_t pieces = 2; items.size() > 1;) {
    pieces = std::min(pieces, items.size());
    const auto piece = [&](std::size_t p) { return p * items.size() / pieces; };  // where it begins
    bool is_less = false;
    for (std::size_t p = 0; p < pieces && !is_less; ++p) {
      const auto begin = items.begin() + static_cast<std::ptrdiff_t>(piece(p)),
                 end = items.begin() + static_cast<std::ptrdiff_t>(piece(p + 1));
      std::vector<T> rest(items.begin(), begin);
      rest.insert(rest.end(), end, items.end());
      if (std::vector<T> alone(begin, end); pieces > 2 && holds(alone)) {
        items = std::move(alone), pieces = 2, is_less = true;
      } else if (holds(rest)) {
        items = std::move(rest), pieces = std::max<std::size_t>(2, pieces - 1), is_less = true;
      }
    }
    if (is_less) continue;
    if (pieces == items.size()) break;
    pieces *= 2;
  }
  return items;
}

}  // namespace impinge
