#include "engine/integrators/turning_swell.hpp"

#include "engine/bodies/deformable_body.hpp"
#include "engine/integrators/mean_turning.hpp"

namespace impinge {

std::optional<TurningSwell> turning_swell(const DeformableBody& body, double h) {
  if (body.free_nodes() < body.nodes()) return std::nullopt;
  TurningSwell swell;
  const double omega = mean_turning(body).norm();
  swell.turn = omega * h;
  swell.strain = 0.5 * omega * omega * h * (h + body.damping.beta);
  for (std::size_t e = 0; e < body.fem.elements().size(); ++e) {
    const auto [mu, lambda] = body.fem.material(static_cast<int>(e)).lame();
    swell.energy += 2.0 * (mu + lambda) * swell.strain * swell.strain * body.fem.elements()[e].volume;
  }
  return swell;
}

}  // namespace impinge
