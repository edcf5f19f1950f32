// Warm starting: a contact begins with the impulse that the same pair of features had in the last sub-step. Contacts of
// bodies at rest keep theirs, however many sub-steps go by, and are not touched meanwhile; copies share them.
#pragma once

#include <compare>
#include <functional>
#include <memory>
#include <span>

#include "engine/core/index.hpp"
#include "engine/core/types.hpp"

namespace impinge {

class ByteReader;
class ByteWriter;

/// Which features of which bodies touch: the same from sub-step to sub-step.
struct ContactKey {
  BodyIndex body_a, body_b;
  std::uint64_t feature = 0;
  // (clang-tidy 14 takes the zero of the comparison it writes itself for a pointer)
  friend auto operator<=>(const ContactKey&, const ContactKey&) = default;  // NOLINT(modernize-use-nullptr)
};

class ContactCache {
 public:
  struct Item {
    ContactKey key;
    Vec3 impulse = Vec3::Zero();  ///< world axes, on A, N·s: survives a normal that turns
  };

  /// The impulse of that contact in the last sub-step; zero if it is new.
  Vec3 find(const ContactKey& key) const;
  /// Replaces the contents. Items need not be sorted; of equal ones the first stays.
  void assign(std::vector<Item> items);
  /// The same, but for items between bodies at rest, which stay. `rests`: of a body, which may be none; `woken`: those that
  /// may rest no longer since this was asked last.
  void renew(std::vector<Item> items, std::span<const BodyIndex> woken, const std::function<bool(BodyIndex)>& rests);
  /// Sorted by key.
  std::vector<Item> items() const;

  void save(ByteWriter& out) const;
  void restore(ByteReader& in);

 private:
  void keep(std::vector<Item> resting);

  std::vector<Item> fresh_;                           // sorted by key
  std::shared_ptr<const std::vector<Item>> resting_;  // the same, other ones; null: none
  std::vector<BodyIndex> at_rest_;                    // bodies of those, ascending
};

}  // namespace impinge
