// What the stress and strain layers share: a quantity of the tetrahedra as colours of surfaces.
#pragma once

#include <span>

#include "engine/geometry/tets/embedding.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {

enum class HeatQuantity { von_mises, mean_stress, equivalent_strain, volume_change };

struct StressSettings {
  HeatQuantity of = HeatQuantity::von_mises;
  ScaleSettings colors;
  void declare(const Rows& rows);
};
struct StrainSettings {
  HeatQuantity of = HeatQuantity::equivalent_strain;
  ScaleSettings colors;
  void declare(const Rows& rows);
};

/// What is shown by colours: strain wins over stress; none if neither layer is on.
std::optional<HeatQuantity> heat_shown(const ViewSettings& settings);

/// The layer that colours the surfaces in place of this one, "" if none does: heat wins over strain, strain over stress.
std::string_view layer_instead_of(std::string_view layer, const ViewSettings& settings);

/// A body that has no colour of the bar is grey, or its own colour, of the palette, would read as a value. Static and
/// scripted ones have none of the palette, and one that the user gave a colour keeps it.
void grey_out(const LayerContext& context, DrawSurface& item);

/// What the heat layer's bar says of points of a body, at the positions and with the velocities given: as shares of the
/// bar, which is in the list. Empty where that layer is off or nothing touches the body.
std::vector<float> heat_at(const LayerContext& context, DrawList& list, std::size_t body, std::span<const Vec3> points,
                           std::span<const Vec3> velocities);

/// Of every tetrahedron: von Mises stress and mean stress (Pa; tension is positive), equivalent strain, J - 1.
std::vector<double> heat_of_elements(const DeformableBody& body, HeatQuantity quantity);

/// From the layer's rows; ends that are left open lie where 99 % of all deformable surfaces' vertices stay below,
/// rounded up to 1, 2 or 5 times a power of ten so that they keep still from frame to frame.
ColorScale heat_scale(const StepRecord& record, const ViewSettings& settings, HeatQuantity quantity);

/// Nodal values at embedded points, by their weights.
std::vector<double> values_at_points(const Embedding& embedding, const TetMesh& mesh,
                                     const std::vector<double>& of_nodes);

/// With its title, and the unit in which the upper end has few digits.
ColorBar heat_bar(HeatQuantity quantity, const ColorScale& scale, ColorMap map);

/// Heats the surfaces of deformable bodies that are in the list, and puts the colour bar there.
void draw_heat(const LayerContext& context, DrawList& list, HeatQuantity quantity);

}  // namespace impinge
