// What a session needs of the view: its parameters, its camera, and frames written as pictures.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "viewer/controller/script.hpp"
#include "viewer/present/frame_painter.hpp"
#include "viewer/present/png_sequence.hpp"

namespace impinge {

class FrameView {
 public:
  FrameView();

  /// Declares the rows `view.*`. The set refers to this object.
  void bind(ParameterSet& rows) { settings_.bind(rows); }
  /// Fixes the proportions of the pictures, and the camera, fitted to the record unless the scene gives one. Throws
  /// InputError (without a place) where the scene names a body that isn't there.
  void settle(const StepRecord& record, int width, int height);
  const ViewSettings& settings() const { return settings_; }
  int width() const { return width_; }
  int height() const { return height_; }
  void move_camera(const CameraCommand& command, const StepRecord& record);
  void show(const BodiesCommand& command, const StepRecord& record);

  /// Makes ready to draw pictures of the settled size; without it no OpenGL is touched. `ids`: id pictures too. Throws
  /// InputError without OpenGL.
  void open(const std::string& scene_name, bool ids = false);
  /// Makes the lines of the script that a picture of the frame has below it, by the rows view.caption.*.
  void write_below(const Script& script, int frame, double frames_per_second);
  /// Draws the frame and hands the picture on, to be written into `folder`/frames, and what its pixels show into
  /// `folder`/ids; returns the milliseconds of drawing.
  double draw(const StepRecord& record, std::span<const Command> commands, const std::filesystem::path& folder);
  /// Returns when all pictures are on the disk. Throws InputError where one can't be written.
  void finish();

 private:
  void fit(const Aabb& box, const StepRecord& record);

  ViewSettings settings_;
  int width_ = 1280, height_ = 720;  // pixels
  std::string scene_name_;
  std::unique_ptr<FramePainter> painter_;
  bool with_ids_ = false;
  std::unique_ptr<PngSequence> pictures_, id_pictures_;
};

/// What sets two pictures apart beyond the tolerance (of 255), in words; "" if nothing does.
std::string picture_difference(const std::filesystem::path& picture, const std::filesystem::path& baseline,
                               int tolerance);

}  // namespace impinge
