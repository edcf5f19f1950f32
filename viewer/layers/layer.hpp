// A debug layer: reads the record, writes marks into the draw list. One file a layer, with its settings, and one line
// in all.cpp.
#pragma once

#include <optional>

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
  std::string_view layer = {};  ///< the one that is being drawn

  /// What it is set to, of the type that its file gives it.
  template <class Settings>
  const Settings& own() const {
    return settings.of_layer<Settings>(layer);
  }
};

/// What one of a layer's marks means.
struct LegendRow {
  enum Mark { area, point, disc, ring, target, line, bar, arrow };
  Mark mark = area;
  Color color;
  const char* text = "";  ///< {}: what the size of the mark stands for (draw_list.hpp: MarkScale)
  /// Whether the scene has such a thing: then it is explained in all frames. Null: where the layer drew something of
  /// the row's colour in this one.
  bool (*present)(const StepRecord& record) = nullptr;
  bool (*used)(const ViewSettings& settings) = nullptr;  ///< whether it is drawn so as things are set; null: it is
  /// Of marks whose colour is not always the same: that of the first one in the picture, none where there is none. Null:
  /// `color`.
  std::optional<Color> (*found)(const DrawList& list) = nullptr;
};

struct Layer {
  std::string_view name, doc;
  bool on;  ///< where nothing says otherwise
  void (*draw)(const LayerContext& context, DrawList& list);
  std::vector<LegendRow> legend;
  /// A struct of the layer's own; its rows stand below `view.NAME`, so a layer with any is not called like a table of
  /// view.*.
  LayerSettings settings = {};
};

/// Every layer, in the order they are drawn.
const std::vector<Layer>& layers();

/// Settings with every layer's switch at its default: what a session starts from.
ViewSettings make_view_settings();

/// A camera that sees the body of that name and as much again to all its sides; where no name is given the scene's moving
/// bodies, what they may fall on and the walls near them.
Camera fitted_camera(const StepRecord& record, const Camera& like, const std::string& followed, double aspect);

}  // namespace impinge
