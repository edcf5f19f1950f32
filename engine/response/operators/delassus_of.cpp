#include "engine/response/operators/delassus_of.hpp"

#include "engine/response/operators/assembled_delassus.hpp"
#include "engine/response/operators/node_delassus.hpp"
#include "engine/response/operators/touched_nodes.hpp"

namespace impinge {
namespace {

constexpr double kFew = 0.8;               // nodes a contact
constexpr std::size_t kFewContacts = 100;  // whose W is small, whatever it is made of

bool has_few_nodes(const GroupSystem& group) {
  if (group.contacts.size() < kFewContacts) return false;
  std::size_t nodes = 0;
  for (int s = 0; s < static_cast<int>(group.deformable.size()); ++s) nodes += touched_nodes(group, s).size();
  return static_cast<double>(nodes) < kFew * static_cast<double>(group.contacts.size());
}

}  // namespace

std::unique_ptr<Delassus> delassus_of(GroupSystem& group) {
  if (has_few_nodes(group)) return std::make_unique<NodeDelassus>(group);
  return std::make_unique<AssembledDelassus>(group);
}

}  // namespace impinge
