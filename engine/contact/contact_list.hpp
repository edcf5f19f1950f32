// What may have rows in a sub-step: the collisions that detection found, and after them the attachments.
#pragma once

#include <span>

#include "engine/contact/attachments.hpp"
#include "engine/contact/contact_cache.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

/// Views of both; a ContactIndex counts through them.
struct ContactList {
  std::span<const Collision> collisions;
  std::span<const Attachment> attachments;

  ContactIndex size() const { return ContactIndex(collisions.size() + attachments.size()); }
  /// Null for an attachment.
  const Collision* collision(ContactIndex i) const {
    return i < collision_count() ? &collisions[static_cast<std::size_t>(i.value())] : nullptr;
  }
  /// In the list of attachments.
  std::size_t attachment_at(ContactIndex i) const { return static_cast<std::size_t>(i - collision_count()); }
  const Attachment& attachment(ContactIndex i) const { return attachments[attachment_at(i)]; }
  /// What its impulse is remembered by from one sub-step to the next.
  ContactKey key(ContactIndex i) const;
  /// The bodies that it joins, A first; none: the world.
  std::pair<BodyIndex, BodyIndex> bodies(ContactIndex i) const;

 private:
  int collision_count() const { return static_cast<int>(collisions.size()); }
};

/// The impulse that each has had in the last sub-step, on A in world axes, N·s; zero of what is new.
std::vector<Vec3> remembered_impulses(const ContactCache& cache, const ContactList& contacts);

}  // namespace impinge
