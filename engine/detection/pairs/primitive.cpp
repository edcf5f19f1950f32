#include "engine/detection/pairs/primitive.hpp"

#include "engine/detection/contacts/ghost_contacts.hpp"
#include "engine/detection/pairs/compound_pairs.hpp"
#include "engine/detection/pairs/deforming_vertices.hpp"
#include "engine/detection/pairs/primitive_pairs.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {
namespace {

using Test = void (*)(ContactSink&);

/// all.cpp's list as a table of types, row the first shape; null where a pair has no test of its own.
class OwnTests {
 public:
  OwnTests() : count_(shape_entries().size()), test_(count_ * count_, nullptr) {
    for (const PairTest& t : pair_tests())
      test_[static_cast<std::size_t>(shape_type(t.first)) * count_ + static_cast<std::size_t>(shape_type(t.second))] =
          t.test;
  }
  Test of(const Shape& first, const Shape& second) const {
    return test_[static_cast<std::size_t>(first.type()) * count_ + static_cast<std::size_t>(second.type())];
  }

 private:
  std::size_t count_;
  std::vector<Test> test_;
};

/// Neither of two planes can move: no contact is asked for.
void plane_plane(ContactSink&) {}

/// The test of two forms, the first of lower rank than the second or equal. A form that has none does not compile.
struct FormTest {
  Test operator()(const Plane*, const Plane*) const { return plane_plane; }
  Test operator()(const Plane*, const ConvexSet*) const { return plane_convex; }
  Test operator()(const Plane*, const SurfaceMesh*) const { return plane_mesh; }
  Test operator()(const ConvexSet*, const ConvexSet*) const { return convex_convex; }
  Test operator()(const ConvexSet*, const SurfaceMesh*) const { return convex_mesh; }
  // two meshes are the triangle search's
  Test operator()(const SurfaceMesh*, const SurfaceMesh*) const { return nullptr; }
  // the other way round
  Test operator()(const ConvexSet*, const Plane*) const { return nullptr; }
  Test operator()(const SurfaceMesh*, const Plane*) const { return nullptr; }
  Test operator()(const SurfaceMesh*, const ConvexSet*) const { return nullptr; }
  // compound_contacts takes compounds apart before it comes to this
  using Parts = const std::vector<ShapePart>*;
  Test operator()(Parts, Parts) const { return nullptr; }
  template <class Other>
  Test operator()(Parts, Other) const {
    return nullptr;
  }
  template <class Other>
  Test operator()(Other, Parts) const {
    return nullptr;
  }
};

}  // namespace

void primitive_contacts(std::span<const Collider> colliders, const BodyPair& pair, const ContactQuery& query,
                        std::vector<Collision>& contacts) {
  static const OwnTests own;
  const Shape &a = *colliders[pair.a].shape, &b = *colliders[pair.b].shape;
  if (a.parts() != nullptr || b.parts() != nullptr) {
    compound_contacts(colliders, pair, query, contacts);
    return;
  }
  bool swapped = false;
  Test test = own.of(a, b);
  if (test == nullptr) test = own.of(b, a), swapped = test != nullptr;
  if (test == nullptr) test = std::visit(FormTest(), a.form(), b.form());
  if (test == nullptr) test = std::visit(FormTest(), b.form(), a.form()), swapped = true;
  IMPINGE_ASSERT(test != nullptr);
  ContactSink sink(colliders, pair, swapped, query, contacts);
  const std::size_t begin = contacts.size();
  test(sink);
  if (query.proximity)
    turn_ghost_contacts(colliders, pair,
                        {query.time_step, query.activation, query.fall, query.sunk, query.either_may_stop}, begin,
                        contacts);
  if (has_deforming_vertices(sink)) add_deforming_vertices(sink);
}

}  // namespace impinge
