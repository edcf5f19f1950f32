#include "engine/lcp/body_matrix.hpp"
#include "engine/lcp/system_of_velocities.hpp"

namespace impinge {
namespace {

class SystemOfBodies : public SystemOfVelocities<BodySpace> {
 public:
  explicit SystemOfBodies(const BodySpace& bodies)
      : SystemOfVelocities(bodies, bodies.sides.size()), matrix_(bodies), free_(bodies) {}

 protected:
  void factorize_velocities(std::span<const Mat3> g) override { matrix_.factorize(g); }
  void solve_velocities(VecX& s) const override { matrix_.solve(s); }
  void free_velocities(VecX& s) const override { free_.apply(s); }

 private:
  BodyMatrix matrix_;
  InverseMasses free_;
};

}  // namespace

std::unique_ptr<NewtonSystem> newton_system_of_bodies(const BodySpace& bodies) {
  return std::make_unique<SystemOfBodies>(bodies);
}

}  // namespace impinge
