// Draws a draw list as a camera sees it. The same list and camera give the same pixels, whatever was drawn before.
#pragma once

#include <map>

#include "viewer/draw/clip_plane.hpp"
#include "viewer/gl/framebuffer.hpp"
#include "viewer/gl/id_buffer.hpp"
#include "viewer/gl/marks.hpp"
#include "viewer/gl/scenery.hpp"

namespace impinge {

struct RenderStyle {
  Backdrop backdrop;
  bool smooth_edges = true;  ///< of surfaces; marks are always smooth
  float pixel_scale = 1.0f;  ///< multiplies every size in pixels
  ClipPlane clip = {};       ///< of surfaces
  Backs backs = Backs::shown;
};

class Renderer {
 public:
  /// A context must be current, here and in every call.
  Renderer() = default;

  /// Draws into `target`, which is left bound.
  void draw(const DrawList& list, const Camera& camera, const RenderStyle& style, Framebuffer& target);

  /// What draw() shows, pixel by pixel. `coded`: the list with colours that are ids, see code_colors().
  void draw_ids(const DrawList& coded, const Camera& camera, const RenderStyle& style, IdBuffer& target);

 private:
  struct SurfaceBuffers {
    std::weak_ptr<const ShadedSurface> surface;
    MovedSurfacePointer moved;  // what the vertex buffer holds
    SurfaceHeat heat;
    VertexArray array;
    int indices = 0;
  };

  SurfaceBuffers& buffers_of(const DrawSurface& item);
  struct IdPass {
    Program surfaces{"surface", "IDS"};
    Grid grid{true};
    Marks marks{true};
  };

  void prepare(Program& program, const DrawList& list, const ViewTransform& view, const RenderStyle& style);
  void draw_solid(Program& program, const DrawList& list, const ViewTransform& view, const RenderStyle& style);
  void draw_surface(Program& program, const DrawSurface& item, const ViewTransform& view, const ClipPlane& clip);
  void draw_see_through(Program& program, const DrawList& list, const ViewTransform& view, const ClipPlane& clip);

  Program surface_program_{"surface"};
  std::map<const ShadedSurface*, SurfaceBuffers> buffers_;
  Scenery scenery_;
  Marks marks_;
  std::unique_ptr<IdPass> id_pass_;  // made when it is first needed
};

}  // namespace impinge
