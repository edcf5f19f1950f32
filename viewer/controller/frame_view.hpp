// What a session needs of the view: its parameters, its camera, and frames written as pictures.
#pragma once

#include <filesystem>
#include <memory>

#include "engine/world/world.hpp"
#include "viewer/controller/command.hpp"
#include "viewer/draw/view_settings.hpp"

namespace impinge {

class FramePainter;
class PngSequence;

class FrameView {
 public:
  FrameView();
  ~FrameView();

  /// Declares the rows `view.*`. The set refers to this object.
  void bind(ParameterSet& rows);
  void move_camera(const CameraCommand& command, const World& world);

  /// Makes ready to draw; without it nothing is drawn and no GL is touched. Throws InputError where that can't be.
  void open(int width, int height, const std::string& scene_name);
  /// Draws the frame and hands the picture on to be written; returns the milliseconds of drawing.
  double draw(const StepRecord& record, std::span<const Command> commands, const std::filesystem::path& path);
  /// Waits until all pictures are on the disk. Throws InputError where one can't be written.
  void finish();

 private:
  ViewSettings settings_;
  int width_ = 1280, height_ = 720;
  std::string scene_name_;
  std::unique_ptr<FramePainter> painter_;
  std::unique_ptr<PngSequence> sequence_;  // made anew after each finish()
};

/// What sets two pictures apart beyond the tolerance (of 255), in words; "" if nothing does.
std::string picture_difference(const std::filesystem::path& picture, const std::filesystem::path& baseline, int tolerance);

}  // namespace impinge
