// Volumes with tetrahedra that are almost flat: they are stiff beyond measure, which solvers by iterations feel first.
#include <fmt/format.h>

#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kLeastAngle = 2.0;  // degrees between two faces; tetrahedralizers promise 5 to 10

class ThinTetrahedra : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    std::vector<Finding> found;
    for (const Body& body : start.world.bodies()) {
      const auto* soft = body.as<DeformableBody>();
      if (soft == nullptr) continue;
      const TetMesh& mesh = soft->fem.rest();
      std::size_t count = 0, worst = 0;
      double smallest = kLeastAngle;
      for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
        const double angle = smallest_dihedral_angle(mesh, mesh.tets[i]);
        if (!(angle < kLeastAngle)) continue;
        ++count;
        if (angle < smallest) smallest = angle, worst = i;
      }
      if (count == 0) continue;
      found.push_back(
          {fmt::format("{} of {} tetrahedra of '{}' have an angle below {:g} degrees, number {} one of {:.2g}", count,
                       mesh.tets.size(), body.name, kLeastAngle, worst, smallest),
           "volume = { cage = { cells = ... } } fills its surface with good ones; with these, "
           "simulation.linear_solver = \"simplicial_llt\" may take less than iterations"});
    }
    return found;
  }
};

}  // namespace

Entry<Warning> thin_tetrahedra_warning() {
  return entry<Warning, ThinTetrahedra>("thin-tetrahedra", "a deformable body has tetrahedra that are almost flat");
}

}  // namespace impinge
