// Turns a step record into a picture: layers -> draw list -> renderer -> panels -> pixels.
#pragma once

#include <memory>
#include <string>

#include "engine/world/step_record.hpp"
#include "viewer/draw/view_settings.hpp"
#include "viewer/image/id_image.hpp"

namespace impinge {

/// The same record and settings give the same pixels, whatever was painted before. Use one painter in one thread at a
/// time.
class FramePainter {
 public:
  /// Throws std::runtime_error if there is no OpenGL, InternalError if the picture is too large for it.
  FramePainter(int width, int height);
  ~FramePainter();
  FramePainter(const FramePainter&) = delete;
  FramePainter& operator=(const FramePainter&) = delete;

  void paint(const StepRecord& record, const ViewSettings& settings, Image& out);
  /// The same picture, and what each of its pixels shows; panels are objects too. Labels belong to what is behind them.
  void paint(const StepRecord& record, const ViewSettings& settings, Image& out, IdImage& ids);
  /// What the colours of the last picture mean, a line a bar; "" where they mean nothing.
  std::string colors() const;
  /// What draws, with its version: "llvmpipe (LLVM 15.0.6, 256 bits) 22.3.6".
  std::string renderer_name() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Fits the camera to the record once, if none was given: call it on frame 0, so that later frames keep the same view.
void settle_camera(ViewSettings& settings, const StepRecord& record, double aspect);

}  // namespace impinge
