// Impacts one after another within a sub-step. A row whose gap closes because of what another impact did in the same
// sub-step has no approach before it that could be reflected: it is braked to touch at the end, and what it should have
// rebounded with is lost. So the sub-step is cut where the first such gap closes, and the rest of it begins with an
// approach. (Gaps of nothing close together: they are one impact, solved as one.)
#pragma once

#include <optional>

#include "engine/bodies/bodies.hpp"
#include "engine/contact/contact_settings.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

/// Whether any two bodies rebound from each other with a part of their energy that is worth a cut, a tenth or more.
bool has_rebounds(const Bodies& bodies, const ContactSettings& settings);

/// Of a step that is solved: the share of it after which the first gap closes, if a row was braked that ought to rebound.
/// Rigid bodies only. `gravity`: of scale_gravity, m/s².
std::optional<double> share_to_first_impact(const Bodies& bodies, const SubStep& step, const ContactSettings& settings,
                                            double gravity);

/// Of a step that is solved: whether its normal impulses do more work than they take, as they may where one row rebounds
/// while another, which its bodies' free motion leaves open, is braked: neither knows that the other came first.
bool wins_energy(const Bodies& bodies, const SubStep& step);

}  // namespace impinge
