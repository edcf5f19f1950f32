#include "engine/step/drive.hpp"

namespace impinge {

void drive(Bodies& bodies, double time, double h, double share) {
  for (const BodyIndex b : bodies.active())
    if (!bodies[b].deleted) bodies[b].drive(time, h, share);
}

void place(Bodies& bodies, double time) {
  for (Body& body : bodies) body.place(time);
}

}  // namespace impinge
