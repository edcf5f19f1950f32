// Small scenes for the tests of the view, and pictures of them.
#pragma once

#include <string>
#include <vector>

#include "tests/support/pictures/hand_made_record.hpp"
#include "viewer/draw/view_settings.hpp"
#include "viewer/image/image.hpp"

namespace impinge::test {

/// One of everything but a plane (its grid is costly to keep as PNG): slab, walls, all shapes, all kinds of bodies,
/// contacts in every state, triangle pairs, two groups.
const StepRecord& sample_record();
/// The same bodies elsewhere.
const StepRecord& other_record();

/// Two deformable bodies: a lump between a slab and a scripted ball with held and moved nodes, and a sheared block with
/// a vertex outside its tetrahedra; contacts with both, an attachment between the two.
const StepRecord& soft_record();

/// A row of the view by its path, in the words of a scene.
void set(ViewSettings& settings, const std::string& path, const std::string& value);
/// Settings with exactly these layers, no panels, a fixed camera.
ViewSettings settings_with(const std::vector<std::string>& layers);
std::vector<std::string> all_layers();

/// Whether pictures are to be written anew, not compared (IMPINGE_UPDATE_BASELINES=1).
bool updating();

/// Painted by a painter that lives as long as the program (one a size).
Image painted(const StepRecord& record, const ViewSettings& settings, int width = 320, int height = 180);

}  // namespace impinge::test
