// How the view looks at a record: camera, layers, sizes, panels. Declared once as parameter rows `view.*`.
#pragma once

#include "engine/core/parameter.hpp"
#include "viewer/draw/camera.hpp"
#include "viewer/draw/clip_plane.hpp"

namespace impinge {

struct LayerSwitch {
  std::string name, doc;
  bool on = false;
};

struct ViewSettings {
  Camera camera;
  bool camera_given = false;        ///< else the painter fits the camera to what it paints
  std::vector<LayerSwitch> layers;  ///< in the order they are drawn; layers/layer.hpp fills them in

  double point_size = 9.0;     ///< diameter of a contact, pixels of a picture 720 high
  double arrow_length = 36.0;  ///< of a normal, and of the largest force or velocity, same pixels
  double line_width = 1.4;     ///< same pixels
  double force_unit = 0.0;     ///< N: the force that is drawn as long as a normal; 0: by the bodies' weights
  bool show_figures = true, show_legend = true, show_timings = false;
  int panel_scale = 0;  ///< text size in steps of 13 pixels; 0: by the picture's height
  bool antialiasing = true;
  std::string backdrop = "dark";

  ClipPlane clip;
  std::string backfaces = "shown";
  std::string tetrahedra_style = "wire";
  double tetrahedra_shrink = 0.75;            ///< of a tetrahedron drawn solid, about its centre
  double stress_max = 0.0, strain_max = 0.0;  ///< Pa and 1: upper ends of the colour bars; 0: by the frame

  bool is_on(std::string_view layer) const;
  /// Throws InputError with the nearest name for a layer that is not there.
  void switch_layer(std::string_view layer, bool on);
  std::vector<std::string> layers_on() const;
  Backs backs() const;

  /// Declares the rows. The set refers to this object, which must outlive it and stay where it is.
  void bind(ParameterSet& rows);
};

}  // namespace impinge
