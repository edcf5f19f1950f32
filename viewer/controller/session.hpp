// A scene with its script, made frame by frame: the one place where commands meet the world and the view.
#pragma once

#include <memory>

#include "engine/core/settings_error.hpp"
#include "engine/io/scene/scene.hpp"
#include "engine/world/figures.hpp"
#include "viewer/controller/added_bodies.hpp"
#include "viewer/controller/condition_values.hpp"
#include "viewer/controller/frame_view.hpp"
#include "viewer/controller/own_columns.hpp"
#include "viewer/controller/script.hpp"
#include "viewer/export/exporter.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {

struct FrozenStep;
class ByteReader;
class ByteWriter;

struct SessionOptions {
  int width = 1280, height = 720;  ///< of pictures, pixels: a camera that the scene doesn't give is fitted to them
  bool judge = false;              ///< whether the judged figures exist, for scripts to name
  bool pictures_may_be_missing = false;                       ///< those that the script's `expect image` lines name
  std::optional<std::vector<std::string>> script_lines = {};  ///< instead of what the script file holds
  bool judge_substeps = false;  ///< judged at the end of each sub-step, and the worst counts
};

class Session {
 public:
  /// Loads and checks everything. `script_file` may be empty: then a run.toml's own script is used, if the scene is
  /// one. Throws InputError.
  Session(const std::filesystem::path& scene_file, const std::vector<std::string>& overrides,
          const std::filesystem::path& script_file, const SessionOptions& options = {});
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Applies the next frame's commands, then makes that frame: the first call gives frame 0. Returns what was applied.
  /// `frozen`, if given, gets the frame's last sub-step; frame 0 has none. Throws DivergenceError.
  std::vector<Command> advance(FrozenStep* frozen = nullptr);

  /// Applies a command between frames, as if the script had it for the next one. Frame 0 must have been made. The record
  /// stays that of the frame; what was done to a body shows in the next.
  void change(const Command& command);

  /// Makes bodies known, absent, that lines by hand add in coming frames, in place of those that were known so far and have
  /// not come to life. True: there are others now. Throws InputError where one can't be had, the old ones then being gone.
  bool list_added(std::vector<Addition> by_hand);
  /// Throws InputError, without a place, where there can be no such body.
  void check_added(const Act& act) const { added_.check(act, scene_); }
  /// How many of rows() belong to parameters and bodies that are there; those of bodies yet to be added come last.
  std::size_t rows_present() const { return added_.rows_present(world_.bodies(), rows_); }

  /// The last frame to make when nobody says otherwise: a run.toml's, or the larger of 240 and the script's last.
  int default_last_frame() const;

  /// World, parameters and view, so that a session with the same scene and script continues bit for bit.
  void save(ByteWriter& out) const;
  void restore(ByteReader& in);

  /// Before frame 0: parameters and bodies become as they are in another session, those that have the same path or name.
  /// All are awake. Throws InputError where a body of that name is of another make.
  void take_over(Session& from);

  int frame() const { return frame_; }  ///< the last one made, -1 before the first
  const World& world() const { return world_; }
  Bodies& bodies() { return world_.bodies(); }
  const StepRecord& record() const { return world_.record(); }
  const ParameterSet& rows() const { return rows_; }
  const Scene& scene() const { return scene_; }
  const Script& script() const { return script_; }
  FrameView& view() { return view_; }
  const FrameView& view() const { return view_; }
  /// Which present paths to write for the former ones that scene, overrides and script name; "" if they name none.
  std::string note_of_former_paths() const;
  /// Codes of warnings that the scene doesn't want to hear of (viewer/preflight).
  const std::vector<std::string>& silenced() const { return silenced_; }
  /// What conditions may speak of: figures and bodies.
  ExpressionWords condition_words() const { return impinge::condition_words(figure_names(judge_), world_.bodies()); }
  const OwnColumns& own_columns() const { return own_columns_; }
  /// Of the frame just made, by own_columns(); `figures` are its own, judged if they are.
  std::vector<double> own_values(std::span<const double> figures);
  StatsShape stats_shape() const { return {judge_, own_columns_.names()}; }
  /// Where record.columns is given.
  std::string place_of_columns() const;
  bool is_judged() const { return judge_; }  ///< asked for, or recorded in a run.toml
  bool is_judged_by_substep() const { return judge_substeps_; }
  /// Who looks on while frames are made, none: null.
  void watch(StepWatcher* watcher) { world_.watch(watcher); }
  /// What exports of its frames need to know of it; where they go, and which, is for whoever asks.
  ExportJob export_job() const;
  /// The file that it was made of: of a run.toml the run's scene.
  std::filesystem::path scene_file() const;
  /// The scene's, script's and program's part of run.toml.
  RunRecord run_record() const;

 private:
  void apply(const Command& command);
  void add_body(const Act& act);
  void read_script();
  void read_columns();
  void start();
  /// Throws InputError where they don't go together, with the place of what was set last.
  void take_parameters();
  InputError placed(const SettingsError& error) const;
  void write_below();
  bool begins_later() const { return scene_.run && !scene_.run->start.empty(); }

  World world_;
  FrameView view_;
  std::vector<std::string> silenced_, column_texts_;
  OwnColumns own_columns_;
  ParameterSet rows_;
  Scene scene_;
  AddedBodies added_;
  Script script_;
  std::filesystem::path script_folder_;
  bool pictures_may_be_missing_ = false;
  std::vector<std::string> script_lines_;
  std::string script_name_;
  bool judge_ = false, judge_substeps_ = false;
  bool changed_ = false;                                       // by hand, since the last frame
  std::vector<std::pair<std::string, std::string>> last_set_;  // paths and places, not taken by the world so far
  int frame_ = -1;
};

}  // namespace impinge
