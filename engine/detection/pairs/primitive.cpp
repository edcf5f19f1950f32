#include "engine/detection/pairs/primitive.hpp"

#include "engine/core/error.hpp"
#include "engine/detection/pairs/primitive_pairs.hpp"

namespace impinge {
namespace {

using Test = void (*)(ContactSink&);

/// Neither of two planes can move: no contact is asked for.
void plane_plane(ContactSink&) {}

// row <= column, in the order of the Shape variant: plane, sphere, box, capsule, mesh. Mesh-mesh is the narrow phase's.
constexpr Test kTests[5][5] = {
    {plane_plane, plane_sphere, plane_box, plane_capsule, plane_mesh},
    {nullptr, sphere_sphere, sphere_box, sphere_capsule, sphere_mesh},
    {nullptr, nullptr, box_box, box_capsule, box_mesh},
    {nullptr, nullptr, nullptr, capsule_capsule, capsule_mesh},
    {nullptr, nullptr, nullptr, nullptr, nullptr},
};

}  // namespace

void primitive_contacts(std::span<const Collider> colliders, const BodyPair& pair, const ContactQuery& query,
                        std::vector<Collision>& contacts) {
  const std::size_t a = colliders[pair.a].shape->index(), b = colliders[pair.b].shape->index();
  const bool swapped = a > b;
  const Test test = swapped ? kTests[b][a] : kTests[a][b];
  IMPINGE_ASSERT(test != nullptr);
  ContactSink sink(colliders, pair, swapped, query, contacts);
  test(sink);
}

bool is_pair_supported(const Shape& a, const Shape& b) {
  if (is_mesh(a) && is_mesh(b)) return true;  // the narrow phase's
  return kTests[std::min(a.index(), b.index())][std::max(a.index(), b.index())] != nullptr;
}

}  // namespace impinge
