#include "viewer/draw/view_settings.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

std::vector<std::string> names_of(const std::vector<LayerSwitch>& layers) {
  std::vector<std::string> names;
  names.reserve(layers.size());
  for (const LayerSwitch& layer : layers) names.push_back(layer.name);
  return names;
}

Parameter vector_row(ViewSettings& settings, const char* path, Vec3 Camera::*member, const char* doc) {
  Parameter row;
  row.path = path;
  row.kind = ParameterKind::vector3;
  row.unit = "m";
  row.range = {-1e9, 1e9};
  row.doc = doc;
  row.initial = settings.camera.*member;
  row.get = [&settings, member] { return ParameterValue(settings.camera.*member); };
  row.set = [&settings, member](const ParameterValue& value) {
    settings.camera.*member = std::get<Vec3>(value);
    settings.camera_given = true;
  };
  return row;
}

}  // namespace

bool ViewSettings::is_on(std::string_view layer) const {
  return std::any_of(layers.begin(), layers.end(), [&](const LayerSwitch& l) { return l.name == layer && l.on; });
}

void ViewSettings::switch_layer(std::string_view layer, bool on) {
  const auto it = std::find_if(layers.begin(), layers.end(), [&](const LayerSwitch& l) { return l.name == layer; });
  if (it == layers.end()) {
    const std::string near = nearest_word(layer, names_of(layers));
    throw InputError(fmt::format("unknown layer '{}'; allowed: {}{}", layer, fmt::join(names_of(layers), ", "),
                                 near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
  }
  it->on = on;
}

std::vector<std::string> ViewSettings::layers_on() const {
  std::vector<std::string> names;
  for (const LayerSwitch& layer : layers)
    if (layer.on) names.push_back(layer.name);
  return names;
}

const LayerSwitch& ViewSettings::layer(std::string_view name) const {
  const auto it = std::find_if(layers.begin(), layers.end(), [&](const LayerSwitch& l) { return l.name == name; });
  if (it == layers.end()) throw InternalError("no layer is named '" + std::string(name) + "'");
  return *it;
}

void ViewSettings::bind_writing(const Rows& rows) {
  rows.add("caption.text", caption, "A text below the picture.");
  rows.add(
      "caption.lines", caption_lines,
      {{CaptionLines::none, "none"}, {CaptionLines::changes, "changes"}, {CaptionLines::all, "all"}},
      "Lines of the script below the pictures of a run, from the frame in which they take effect: those that change "
      "what happens, or all, those of the view too.");
  rows.add("caption.time", caption_time, {0.0, 1e9, true}, "s", "How long such a line stays, in simulated time.");
  rows.add("panel.figures", show_figures, "The panel of figures, left out where the picture is too small for it.");
  rows.add("panel.legend", show_legend, "What the marks of the visible layers mean, left out where there is no room.");
  rows.add("panel.legend_form", legend_form,
           {{LegendForm::automatic, "automatic"}, {LegendForm::whole, "whole"}, {LegendForm::folded, "folded"}},
           "Folded, the legend is a heading; automatic, it is where it would cover a tenth of the picture, or in the "
           "debugger what is picked wherever it stood.");
  rows.add("panel.timings", show_timings,
           "Times of the stages among the figures; pictures then differ from run to run.");
  rows.add("panel.scale", panel_scale, {0, 16}, "",
           "Text size in steps of 13 pixels; 0 chooses by the picture's shorter side.");
}

void ViewSettings::bind(ParameterSet& set) {
  const Rows all(set), rows = all.below("view");
  all.add(vector_row(*this, "view.camera.eye", &Camera::eye,
                     "Where the camera is; without eye and target it is fitted to the scene."));
  all.add(vector_row(*this, "view.camera.target", &Camera::target, "What the camera looks at."));
  Parameter distance;
  distance.path = "view.camera.distance";
  distance.kind = ParameterKind::real;
  distance.unit = "m";
  distance.range = {1e-9, 1e9, true};
  distance.doc = "From the camera to its target; setting it moves the camera along its line of sight.";
  distance.initial = camera.distance();
  distance.get = [this] { return ParameterValue(camera.distance()); };
  distance.set = [this](const ParameterValue& value) {
    const double wanted = std::get<double>(value), now = camera.distance();
    if (wanted == now || now == 0.0) return;  // what a record of all values repeats must not round the eye
    camera.eye = camera.target + (camera.eye - camera.target) * (wanted / now);
    camera_given = true;
  };
  all.add(std::move(distance));
  rows.add("camera.fov", camera.fov_deg, {1.0, 170.0}, "deg", "Vertical angle of view.");
  rows.add("camera.follow", followed,
           "The body that the camera goes along with: eye and target are then relative to its centre.");

  rows.add(
      "camera.fit", camera_fit, {{CameraFit::start, "start"}, {CameraFit::all, "all"}},
      "The camera stays where it was put, by itself or by eye and target; or it goes back from there in each picture, "
      "as far as it takes to have all bodies in it that move.");

  Parameter list;
  list.path = "view.layers";
  list.kind = ParameterKind::text_list;
  list.names = names_of(layers);
  list.doc = "The layers that are shown; all others are off.";
  list.initial = layers_on();
  list.get = [this] { return ParameterValue(layers_on()); };
  list.set = [this](const ParameterValue& value) {
    for (LayerSwitch& layer : layers) layer.on = false;
    for (const std::string& name : std::get<std::vector<std::string>>(value)) switch_layer(name, true);
  };
  all.add(std::move(list));
  for (LayerSwitch& layer : layers) rows.below("layer").add(layer.name, layer.on, layer.doc);
  for (LayerSwitch& layer : layers) layer.settings.declare(rows.below(layer.name));

  rows.add("point_size", point_size, {1.0, 100.0}, "px",
           "Diameter of a contact point, in pixels of a picture whose shorter side has 720.");
  rows.add("arrow_length", arrow_length, {1.0, 1000.0}, "px",
           "Length of a normal and of the unit of forces and of spins that the legend shows, in pixels of a picture "
           "whose shorter side has 720.");
  rows.add("arrow_most", arrow_most, {1.0, 100.0}, "",
           "The longest arrow of a force or a spin, in lengths of view.arrow_length; what is more is drawn that long, "
           "with two heads.");
  rows.add("line_width", line_width, {0.5, 20.0}, "px",
           "Width of lines, in pixels of a picture whose shorter side has 720.");
  rows.add("antialiasing", antialiasing, "Smooth edges of surfaces; marks are smooth in any case.");
  rows.add("backdrop", backdrop,
           {{BackdropStyle::dark, "dark"},
            {BackdropStyle::light, "light"},
            {BackdropStyle::flat, "flat"},
            {BackdropStyle::transparent, "transparent"}},
           "What stands behind the scene; flat is one colour, for pictures that are compared; transparent nothing, for "
           "pictures that are laid over others.");
  rows.add("color_map", color_map, {{ColorMap::dusk, "dusk"}, {ColorMap::fire, "fire"}, {ColorMap::gray, "gray"}},
           "Colours of quantities: violet over teal to yellow; black red over orange to pale yellow; dark to light "
           "gray. A diverging scale goes from blue over white to rust whatever this says.");
  rows.add("clip.enabled", clip.enabled,
           "Cut surfaces and tetrahedra by a plane, to see into bodies; marks are never cut.");
  rows.add("clip.normal", clip.normal, {-1e9, 1e9}, "",
           "Towards the side of the clip plane that is left out; of any length but zero.");
  rows.add("clip.offset", clip.offset, {-1e9, 1e9}, "m",
           "Distance of the clip plane from the origin along its normal.");
  rows.add("backfaces", backs, {{Backs::shown, "shown"}, {Backs::hidden, "hidden"}, {Backs::only, "only"}},
           "Backs of surfaces; only leaves the fronts out, so that bodies are seen from inside.");
  rows.add("hidden", hidden, "Bodies that are not drawn; a contact is while one of its two bodies is.");
  rows.add("locked", locked, "Bodies that can't be picked in the view: a click goes through them.");
  rows.add("colors", colors,
           "Colours of bodies, \"NAME=rrggbb\" each; those that are not named take turns through the palette.");
  bind_writing(rows);
}

}  // namespace impinge
