// The coefficients of two bodies in contact; a body that names none has the scene's.
#pragma once

#include "engine/bodies/body.hpp"
#include "engine/contact/contact_settings.hpp"

namespace impinge {

/// √(mu_A mu_B).
double pair_friction(const Body& a, const Body& b, const ContactSettings& scene);
/// The larger.
double pair_restitution(const Body& a, const Body& b, const ContactSettings& scene);

}  // namespace impinge
