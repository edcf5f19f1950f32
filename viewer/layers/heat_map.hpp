// What the stress and strain layers share: a quantity of the tetrahedra as colours of surfaces.
#pragma once

#include "engine/geometry/tets/embedding.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {

enum class HeatQuantity { stress, strain };

/// Of either layer.
struct HeatSettings {
  Range range;
  std::string unit, doc;
  double max = 0.0;  ///< upper end of the colour bar; 0: by the frame

  void declare(const Rows& rows) { rows.add("max", max, range, unit, doc); }
};

/// What is shown by colours: strain wins over stress; none if neither layer is on.
std::optional<HeatQuantity> heat_shown(const ViewSettings& settings);

/// von Mises stress (Pa) or equivalent strain of every tetrahedron.
std::vector<double> heat_of_elements(const DeformableBody& body, HeatQuantity quantity);

/// The end of the colour bar: the setting's, or what 99 % of all deformable surfaces' vertices stay below, rounded up
/// to 1, 2 or 5 times a power of ten so that it keeps still from frame to frame.
double heat_high(const StepRecord& record, const ViewSettings& settings, HeatQuantity quantity);

/// Nodal values at embedded points, by their weights.
std::vector<double> values_at_points(const Embedding& embedding, const TetMesh& mesh,
                                     const std::vector<double>& of_nodes);

/// Title, and the unit in which `high` has few digits.
ColorBar make_color_bar(HeatQuantity quantity, double high);

/// Heats the surfaces of deformable bodies that are in the list, and puts the colour bar there.
void draw_heat(const LayerContext& context, DrawList& list, HeatQuantity quantity);

}  // namespace impinge
