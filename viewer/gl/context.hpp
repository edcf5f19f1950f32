// Where OpenGL comes from. One seam, so that leaving OSMesa (gone from Mesa 25.1 on) is one more file beside it.
#pragma once

#include <memory>
#include <string>

namespace impinge {

/// An OpenGL 3.3 core context without a window. Its default framebuffer is never drawn to: own framebuffers give the
/// same pixels on every way to a context.
class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Makes it the calling thread's context. Throws InternalError if it cannot be.
  virtual void make_current() = 0;
  /// What draws, with its version: "llvmpipe (LLVM 15.0.6, 256 bits) 22.3.6".
  virtual std::string renderer_name() const = 0;
};

/// A context drawn by the processor (OSMesa). Throws std::runtime_error if there is none.
std::unique_ptr<GlContext> make_offscreen_context();

}  // namespace impinge
