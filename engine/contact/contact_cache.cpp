#include "engine/contact/contact_cache.hpp"

#include <algorithm>

#include "engine/core/archive.hpp"

namespace impinge {

Vec3 ContactCache::find(const ContactKey& key) const {
  const auto at =
      std::lower_bound(items_.begin(), items_.end(), key, [](const Item& i, const ContactKey& k) { return i.key < k; });
  return at != items_.end() && at->key == key ? at->impulse : Vec3::Zero();
}

void ContactCache::assign(std::vector<Item> items) {
  items_ = std::move(items);
  // those of bodies at rest come first, in order as they were
  const auto before = [](const Item& l, const Item& r) { return l.key < r.key; };
  const auto fresh = std::is_sorted_until(items_.begin(), items_.end(), before);
  std::stable_sort(fresh, items_.end(), before);
  std::inplace_merge(items_.begin(), fresh, items_.end(), before);
  items_.erase(std::unique(items_.begin(), items_.end(), [](const Item& l, const Item& r) { return l.key == r.key; }),
               items_.end());
}

void ContactCache::save(ByteWriter& out) const {
  out.put<std::uint64_t>(items_.size());
  static_assert(sizeof(Item) == 2 * sizeof(int) + sizeof(std::uint64_t) + sizeof(Vec3), "items lie as they are kept");
  out.put_bytes(items_.data(), items_.size() * sizeof(Item));
}

void ContactCache::restore(ByteReader& in) {
  items_.clear();
  for (std::uint64_t n = in.get<std::uint64_t>(); n > 0; --n) {
    Item item;
    item.key.body_a = BodyIndex(in.get<int>());
    item.key.body_b = BodyIndex(in.get<int>());
    item.key.feature = in.get<std::uint64_t>();
    item.impulse = in.get_vec3();
    items_.push_back(item);
  }
}

}  // namespace impinge
