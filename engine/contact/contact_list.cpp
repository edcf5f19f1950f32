#include "engine/contact/contact_list.hpp"

namespace impinge {
namespace {
constexpr std::uint64_t kAttachmentFeature = std::uint64_t{1} << 63;  // no pair of features has this bit
}

std::pair<BodyIndex, BodyIndex> ContactList::bodies(ContactIndex i) const {
  if (const Collision* c = collision(i)) return {c->body_a, c->body_b};
  return {attachment(i).a.body, attachment(i).b.body};
}

ContactKey ContactList::key(ContactIndex i) const {
  const auto [a, b] = bodies(i);
  const Collision* c = collision(i);
  return {a, b, c != nullptr ? c->feature : kAttachmentFeature | attachment_at(i)};
}

std::vector<Vec3> remembered_impulses(const ContactCache& cache, const ContactList& contacts) {
  std::vector<Vec3> impulses;
  impulses.reserve(static_cast<std::size_t>(contacts.size().value()));
  for (ContactIndex i(0); i < contacts.size(); ++i) impulses.push_back(cache.find(contacts.key(i)));
  return impulses;
}

}  // namespace impinge
