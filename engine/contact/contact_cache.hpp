// Warm starting: a contact begins with the impulse that the same pair of features had in the last sub-step.
#pragma once

#include <compare>
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
  std::span<const Item> items() const { return items_; }
  void clear() { items_.clear(); }

  void save(ByteWriter& out) const;
  void restore(ByteReader& in);

 private:
  std::vector<Item> items_;  // sorted by key
};

}  // namespace impinge
