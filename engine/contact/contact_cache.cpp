#include "engine/contact/contact_cache.hpp"

#include <algorithm>

#include "engine/core/archive.hpp"

namespace impinge {
namespace {
auto key(const ContactCache::Item& item) { return std::make_tuple(item.body_a, item.body_b, item.feature); }
}  // namespace

Vec3 ContactCache::find(int body_a, int body_b, std::uint64_t feature) const {
  const auto wanted = std::make_tuple(body_a, body_b, feature);
  const auto at =
      std::lower_bound(items_.begin(), items_.end(), wanted, [](const Item& i, const auto& k) { return key(i) < k; });
  return at != items_.end() && key(*at) == wanted ? at->impulse : Vec3::Zero();
}

void ContactCache::assign(std::vector<Item> items) {
  items_ = std::move(items);
  std::stable_sort(items_.begin(), items_.end(), [](const Item& l, const Item& r) { return key(l) < key(r); });
  items_.erase(std::unique(items_.begin(), items_.end(), [](const Item& l, const Item& r) { return key(l) == key(r); }),
               items_.end());
}

void ContactCache::save(ByteWriter& out) const {
  out.put<std::uint64_t>(items_.size());
  for (const Item& item : items_)
    out.put(item.body_a), out.put(item.body_b), out.put(item.feature), out.put(item.impulse);
}

void ContactCache::restore(ByteReader& in) {
  items_.clear();
  for (std::uint64_t n = in.get<std::uint64_t>(); n > 0; --n) {
    Item item;
    item.body_a = in.get<int>();
    item.body_b = in.get<int>();
    item.feature = in.get<std::uint64_t>();
    item.impulse = in.get_vec3();
    items_.push_back(item);
  }
}

}  // namespace impinge
