// Warm starting: a contact begins with the impulse that the same pair of features had in the last sub-step.
#pragma once

#include <span>

#include "engine/detection/collision.hpp"

namespace impinge {

class ByteReader;
class ByteWriter;

class ContactCache {
 public:
  struct Item {
    int body_a = -1, body_b = -1;
    std::uint64_t feature = 0;
    Vec3 impulse = Vec3::Zero();  ///< world axes, on A, N·s: survives a normal that turns
  };

  /// The impulse of that contact in the last sub-step; zero if it is new.
  Vec3 find(int body_a, int body_b, std::uint64_t feature) const;
  /// Replaces the contents. Items need not be sorted; of equal ones the first stays.
  void assign(std::vector<Item> items);
  std::span<const Item> items() const { return items_; }
  void clear() { items_.clear(); }

  void save(ByteWriter& out) const;
  void restore(ByteReader& in);

 private:
  std::vector<Item> items_;  // sorted by (body_a, body_b, feature)
};

}  // namespace impinge
