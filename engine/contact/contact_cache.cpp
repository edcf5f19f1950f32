#include "engine/contact/contact_cache.hpp"

#include <algorithm>

#include "engine/core/archive.hpp"

namespace impinge {

namespace {

using Items = std::vector<ContactCache::Item>;

bool is_before(const ContactCache::Item& l, const ContactCache::Item& r) { return l.key < r.key; }

const ContactCache::Item* find_in(const Items& items, const ContactKey& key) {
  const auto at = std::lower_bound(items.begin(), items.end(), key,
                                   [](const ContactCache::Item& i, const ContactKey& k) { return i.key < k; });
  return at != items.end() && at->key == key ? &*at : nullptr;
}

/// Of equal ones the first stays.
void put_in_order(Items& items) {
  std::stable_sort(items.begin(), items.end(), is_before);
  const auto is_same = [](const auto& l, const auto& r) { return l.key == r.key; };
  items.erase(std::unique(items.begin(), items.end(), is_same), items.end());
}

}  // namespace

Vec3 ContactCache::find(const ContactKey& key) const {
  const Item* item = find_in(fresh_, key);
  if (item == nullptr && resting_ != nullptr) item = find_in(*resting_, key);
  return item != nullptr ? item->impulse : Vec3::Zero();
}

void ContactCache::assign(std::vector<Item> items) {
  keep({});
  put_in_order(items);
  fresh_ = std::move(items);
}

void ContactCache::keep(std::vector<Item> resting) {
  at_rest_.clear();
  for (const Item& item : resting)
    for (const BodyIndex b : {item.key.body_a, item.key.body_b})
      if (!b.is_none()) at_rest_.push_back(b);
  std::sort(at_rest_.begin(), at_rest_.end());
  at_rest_.erase(std::unique(at_rest_.begin(), at_rest_.end()), at_rest_.end());
  resting_ = resting.empty() ? nullptr : std::make_shared<const Items>(std::move(resting));
}

void ContactCache::renew(std::vector<Item> items, std::span<const BodyIndex> woken,
                         const std::function<bool(BodyIndex)>& rests) {
  const auto is_at_rest = [&](const Item& item) { return rests(item.key.body_a) && rests(item.key.body_b); };
  Items come, stay;
  std::copy_if(fresh_.begin(), fresh_.end(), std::back_inserter(come), is_at_rest);
  const bool is_any_woken = std::any_of(woken.begin(), woken.end(), [&](BodyIndex b) {
    return std::binary_search(at_rest_.begin(), at_rest_.end(), b) && !rests(b);
  });
  if (is_any_woken || !come.empty()) {
    if (resting_ != nullptr) std::copy_if(resting_->begin(), resting_->end(), std::back_inserter(stay), is_at_rest);
    Items all;
    std::merge(stay.begin(), stay.end(), come.begin(), come.end(), std::back_inserter(all), is_before);
    keep(std::move(all));
  }
  put_in_order(items);
  if (resting_ != nullptr)
    std::erase_if(items, [&](const Item& item) { return find_in(*resting_, item.key) != nullptr; });
  fresh_ = std::move(items);
}

std::vector<ContactCache::Item> ContactCache::items() const {
  if (resting_ == nullptr) return fresh_;
  Items all;
  std::merge(resting_->begin(), resting_->end(), fresh_.begin(), fresh_.end(), std::back_inserter(all), is_before);
  return all;
}

void ContactCache::save(ByteWriter& out) const {
  const Items all = items();
  out.put<std::uint64_t>(all.size());
  static_assert(sizeof(Item) == 2 * sizeof(int) + sizeof(std::uint64_t) + sizeof(Vec3), "items lie as they are kept");
  out.put_bytes(all.data(), all.size() * sizeof(Item));
}

void ContactCache::restore(ByteReader& in) {
  Items items;
  for (std::uint64_t n = in.get<std::uint64_t>(); n > 0; --n) {
    Item item;
    item.key.body_a = BodyIndex(in.get<int>());
    item.key.body_b = BodyIndex(in.get<int>());
    item.key.feature = in.get<std::uint64_t>();
    item.impulse = in.get_vec3();
    items.push_back(item);
  }
  assign(std::move(items));
}

}  // namespace impinge
