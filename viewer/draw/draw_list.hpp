// What is to be drawn, as plain data: layers write it, the renderer reads it. No OpenGL, no physics.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "viewer/draw/color_scale.hpp"
#include "viewer/draw/moved_surface.hpp"
#include "viewer/draw/palette.hpp"

namespace impinge {

/// tested: hidden by what is in front. on_top: never hidden. both: solid where visible, faint where hidden.
enum class Depth : std::uint8_t { tested, on_top, both };

/// What a mark belongs to, for picking: 0 is nothing, body i is i + 1, contact i has the top bit set.
using PickId = std::uint32_t;
constexpr PickId body_pick(std::size_t body) { return static_cast<PickId>(body + 1); }
constexpr PickId contact_pick(std::size_t contact) { return 0x80000000u | static_cast<PickId>(contact); }

/// A disc with a dark rim, of constant size, or smaller where what it marks looks small.
struct DrawPoint {
  Vec3 position;
  Color color;
  float diameter = 8.0f;  ///< pixels
  Depth depth = Depth::on_top;
  PickId pick = 0;
  double room = 0.0;  ///< metres: no larger than that looks there, down to a third of `diameter`; 0: constant
};

struct DrawLine {
  Vec3 a, b;
  Color color;
  float width = 1.5f;  ///< pixels
  Depth depth = Depth::tested;
  PickId pick = 0;
};

/// From `tail` along `direction`. With length_px > 0 it is that long on the screen where it lies across the line of
/// sight, and the direction is a unit vector; else it ends at tail + direction.
struct DrawArrow {
  Vec3 tail, direction;
  Color color;
  float length_px = 0.0f;
  float width = 2.5f;  ///< of the shaft, pixels
  Depth depth = Depth::on_top;
  PickId pick = 0;
  bool has_head = true;  ///< else a bar from its tail
  bool is_cut = false;   ///< it stands for more than its length says
};

/// What a size in the picture means: an arrow's length, or a disc's diameter, that stands for `value`.
struct MarkScale {
  std::string_view layer;
  Color color;  ///< of its marks, and of the layer's row in the legend
  double value = 0.0;
  std::string unit;  ///< SI
  float size_px = 0.0f;
  double most = 0.0;  ///< what arrows stand for at least that are cut
};

/// A quantity at each position of a surface, as a share of the colour bar's range.
using SurfaceHeat = std::shared_ptr<const std::vector<float>>;

/// A surface in its own frame, placed by `pose`; or a deformed one, which needs no pose.
struct DrawSurface {
  ShadedSurfacePointer surface;
  Pose pose;
  Color color;
  bool see_through = false;  ///< hardly more than its edges: what lies behind matters more
  bool striped = false;      ///< marked with bands: moved by a script
  PickId pick = 0;
  MovedSurfacePointer moved = nullptr;  ///< where `surface`'s positions are now; null: it has its own shape
  SurfaceHeat heat = nullptr;           ///< replaces the colour; null: none
  bool clipped = true;                  ///< cut by the view's clip plane
  float faintness = 1.0f;               ///< of a see-through one: below 1 its colour counts more
  bool asleep = false;                  ///< its colour says that the body sleeps

  const Eigen::AlignedBox3f& bounds() const { return moved ? moved->bounds : surface->bounds; }
  Pose placement() const { return moved ? Pose{Mat3::Identity(), moved->origin} : pose; }
  bool is_solid() const { return moved ? moved->solid : surface->solid; }
};

/// A single triangle laid over a surface.
struct DrawTriangle {
  std::array<Vec3, 3> corners;
  Color color;
  Depth depth = Depth::tested;
  PickId pick = 0;
};

/// The half-space below it is solid; drawn as a finite grid seen from above only.
struct DrawPlane {
  Vec3 normal;          ///< unit
  double offset = 0.0;  ///< normal·x = offset
  Color color;
  PickId pick = 0;
};

struct DrawLabel {
  Vec3 position;
  std::string text;
  Color color = role::kInk;
  PickId pick = 0;
};

/// How much of a draw list there was when a layer had drawn.
struct DrawnLayer {
  std::string_view name;
  std::size_t points = 0, lines = 0, arrows = 0, surfaces = 0, triangles = 0, planes = 0;
};

struct DrawList {
  std::vector<DrawPoint> points;
  std::vector<DrawLine> lines;
  std::vector<DrawArrow> arrows;
  std::vector<DrawSurface> surfaces;
  std::vector<DrawTriangle> triangles;
  std::vector<DrawPlane> planes;
  std::vector<DrawLabel> labels;
  std::vector<ColorBar> color_bars;  ///< of heated surfaces the first
  std::vector<MarkScale> scales;     ///< of marks whose sizes are to be read
  std::vector<DrawnLayer> layers;    ///< in the order of drawing; may be empty

  void clear();
  /// What was added since the last such call belongs to that layer.
  void end_layer(std::string_view name);
  /// Whether the layer drew something in that colour, of any opacity.
  bool has_color(std::string_view layer, Color color) const;
  /// Whether an arrow of it, in that colour, stands for more than its length says.
  bool has_cut_arrow(std::string_view layer, Color color) const;
  /// Takes away what belongs to such things.
  void leave_out(const std::function<bool(PickId)>& is_out);
  /// The twelve edges of a box given in the frame of `pose`.
  void add_box(const Pose& pose, const Vec3& low, const Vec3& high, Color color, float width, Depth depth, PickId pick);
};

}  // namespace impinge
