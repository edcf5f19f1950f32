// How the view looks at a record: camera, layers, sizes, panels. Declared once as parameter rows `view.*`; what
// belongs to one layer is that layer's own, below `view.NAME`.
#pragma once

#include "engine/core/parameter.hpp"
#include "viewer/draw/camera.hpp"
#include "viewer/draw/clip_plane.hpp"
#include "viewer/draw/color_map.hpp"
#include "viewer/draw/layer_settings.hpp"

namespace impinge {

/// A layer as a view has it.
struct LayerSwitch {
  std::string name, doc;
  bool on = false;
  LayerSettings settings = {};
};

/// What stands behind the scene.
enum class BackdropStyle { dark, light, flat, transparent };

/// How much of the legend is seen: of the automatic one only its heading where it would cover too much.
enum class LegendForm { automatic, whole, folded };

/// Which lines of the script stand below a picture for a while: those that change what happens, or also what is seen.
enum class CaptionLines { none, changes, all };

/// Where the camera stands in a picture: where it was put, or so far back from there that all that moves is in it.
enum class CameraFit { start, all };

struct ViewSettings {
  Camera camera;
  CameraFit camera_fit = CameraFit::start;
  bool camera_given = false;        ///< else the painter fits the camera to what it paints
  std::string followed;             ///< body whose centre eye and target are relative to; "": they are the world's
  std::vector<LayerSwitch> layers;  ///< in the order they are drawn; layers/layer.hpp fills them in

  double point_size = 9.0;     ///< diameter of a contact, pixels of a picture 720 high
  double arrow_length = 36.0;  ///< of a normal, and of the unit of forces and spins, same pixels
  double arrow_most = 3.0;     ///< times that: no arrow of a force or spin is longer
  double line_width = 1.4;     ///< same pixels
  bool show_figures = true, show_legend = true, show_timings = false;
  LegendForm legend_form = LegendForm::automatic;
  int panel_scale = 0;  ///< text size in steps of 13 pixels; 0: by the shorter side of the picture
  bool antialiasing = true;
  BackdropStyle backdrop = BackdropStyle::dark;
  ColorMap color_map = ColorMap::dusk;

  ClipPlane clip;
  Backs backs = Backs::shown;

  // bodies by name
  std::vector<std::string> hidden;  ///< not drawn
  std::vector<std::string> locked;  ///< drawn, and a click goes through them
  std::vector<std::string> colors;  ///< NAME=rrggbb (draw/body_color)

  // what is written below a picture
  std::string caption;
  CaptionLines caption_lines = CaptionLines::none;
  double caption_time = 2.0;  ///< of a line, seconds of the simulation
  /// The lines themselves, the latest last. No row: whoever has the script finds them.
  std::vector<std::string> lines_shown;

  // What a debugger has picked. No rows: pictures of a run have none of it.
  std::vector<std::string> selected;  ///< bodies
  Aabb picked;                        ///< around it, in the world: panels keep away from it
  double most_legend = 0.1;           ///< share of the picture that an automatic legend may cover

  bool is_on(std::string_view layer) const;
  /// Throws InputError with the nearest name for a layer that is not there.
  void switch_layer(std::string_view layer, bool on);
  std::vector<std::string> layers_on() const;
  /// What a layer is set to, of the type that its file gives it.
  template <class Settings>
  const Settings& of_layer(std::string_view name) const {
    return layer(name).settings.template as<Settings>();
  }

  /// Declares the rows. The set refers to this object, which must outlive it and stay where it is.
  void bind(ParameterSet& set);

 private:
  void bind_writing(const Rows& rows);  ///< of captions and panels
  const LayerSwitch& layer(std::string_view name) const;
};

}  // namespace impinge
