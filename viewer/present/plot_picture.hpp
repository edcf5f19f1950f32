// Plots as pictures.
#pragma once

#include "viewer/image/image.hpp"
#include "viewer/panels/overlay/heat_table.hpp"
#include "viewer/panels/overlay/plot.hpp"

namespace impinge {

/// The same plot gives the same pixels. Throws std::runtime_error if there is no OpenGL.
std::vector<Image> paint_plots(const std::vector<Plot>& plots, int width, int height);
Image paint_heat_table(const HeatTable& table, int width, int height);

}  // namespace impinge
