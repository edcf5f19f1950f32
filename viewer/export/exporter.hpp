// Where frames go that other programs read: a format is one file of this folder and one line of all.cpp. A run that is
// being made and the folder of a finished one hand their frames over alike, in order.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/core/registry.hpp"
#include "engine/world/step_record.hpp"

namespace impinge {

struct ExportJob {
  std::filesystem::path folder;          ///< there already; the files' own names are the format's
  std::string name;                      ///< of the scene, fit for a file's name
  std::string option;                    ///< what asked for it, for messages: "--format gltf"
  int first = 0, stride = 1;             ///< frames of the scene
  int frames = 0;                        ///< how many will come, at most
  std::vector<std::string> colors = {};  ///< of bodies: entries of view.colors
  double frame_time = 0.0;               ///< seconds from one frame of the scene to the next, as it starts
};

class Exporter {
 public:
  virtual ~Exporter() = default;
  /// `start`: the bodies as loaded, whatever the first frame is, and behind them those that will be added: records of
  /// frames before have fewer. Throws InputError, with nothing written, where the
  /// format cannot take the job.
  virtual void begin(const ExportJob& job, const StepRecord& start) = 0;
  /// The next frame. Throws OutputError where it can't be written.
  virtual void add(const StepRecord& record) = 0;
  /// No frame comes any more. Files that hold several frames appear now: without it there are none.
  virtual void finish() = 0;
  /// What there is to open, for who asked for it; "" if there is nothing.
  virtual std::string result() const = 0;
};

/// All formats by the names that --format takes.
const Registry<Exporter>& exporters();

/// The scene's name as files may have it: what is neither a letter, a digit, - nor _ becomes _.
std::string export_name(const std::filesystem::path& scene);

}  // namespace impinge
