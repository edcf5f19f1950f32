#include "engine/response/operators/delassus_of.hpp"

#include "engine/response/operators/assembled_delassus.hpp"
#include "engine/response/operators/factored_delassus.hpp"
#include "engine/response/operators/node_delassus.hpp"
#include "engine/response/operators/touched_nodes.hpp"

namespace impinge {
namespace {

constexpr double kFew = 0.8;               // nodes a contact
constexpr std::size_t kFewContacts = 100;  // whose W is small, whatever it is made of

}  // namespace

std::unique_ptr<Delassus> delassus_of(GroupSystem& group) {
  if (group.deformable.empty()) return std::make_unique<FactoredDelassus>(group);
  if (group.contacts.size() >= kFewContacts) {
    const std::vector<std::vector<int>> nodes = touched_nodes(group);
    std::size_t count = 0;
    for (const std::vector<int>& of_body : nodes) count += of_body.size();
    if (static_cast<double>(count) < kFew * static_cast<double>(group.contacts.size()))
      return std::make_unique<NodeDelassus>(group, nodes);
  }
  return std::make_unique<AssembledDelassus>(group);
}

}  // namespace impinge
