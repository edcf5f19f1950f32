// A debug layer: reads the record, writes marks into the draw list. One file a layer and one line in all.cpp.
#pragma once

#include "engine/world/step_record.hpp"
#include "viewer/draw/draw_list.hpp"
#include "viewer/draw/surface_cache.hpp"
#include "viewer/draw/view_settings.hpp"

namespace impinge {

struct LayerContext {
  const StepRecord& record;
  const ViewSettings& settings;
  const Camera& camera;  ///< the one in use, fitted if none was given
  SurfaceCache& surfaces;
};

/// What one of a layer's marks means.
struct LegendRow {
  enum Mark { area, point, ring, line, arrow };
  Mark mark = area;
  Color color;
  const char* text = "";
  bool (*present)(const StepRecord& record) = nullptr;  ///< whether the scene has such a thing; null: it may
};

struct Layer {
  std::string_view name, doc;
  bool on;  ///< where nothing says otherwise
  void (*draw)(const LayerContext& context, DrawList& list);
  std::vector<LegendRow> legend;
};

/// Every layer, in the order they are drawn.
const std::vector<Layer>& layers();

/// Settings with every layer's switch at its default: what a session starts from.
ViewSettings make_view_settings();

/// A camera that sees the scene's moving bodies, what they may fall on and the walls near them.
Camera fitted_camera(const StepRecord& record, const Camera& like, double aspect);

}  // namespace impinge
