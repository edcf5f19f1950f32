// The debugger's controller: a session that can be stepped, taken back and changed by command lines, whoever writes
// them: a script, the console, a panel or a key. Lines in, a DebugModel for the view out, and a recording of what was
// done.
//
// Going back restores the nearest earlier state and repeats what was done since, so any frame comes out bit for bit. A
// change of the model in the past forgets the frames after it.
//
// Within a frame the world is at one of its stages (engine/world/stage_watch.hpp): come to by making the frame again as far
// as that, and left by restoring the frame's end. The frame itself was made before, whole, so that where the debugger
// stands in it changes nothing of what follows.
#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "viewer/bundle/bundle.hpp"
#include "viewer/controller/breakpoints.hpp"
#include "viewer/controller/expectations.hpp"
#include "viewer/controller/session.hpp"
#include "viewer/debugger/against.hpp"
#include "viewer/debugger/edits.hpp"
#include "viewer/debugger/line.hpp"
#include "viewer/debugger/snapshot_ring.hpp"
#include "viewer/panels/debug/ui.hpp"

namespace impinge {

struct DebuggerOptions {
  SessionOptions session;
  std::size_t most_bytes = std::size_t{256} << 20;  ///< of states kept for going back
  /// a finished run's, "" for none: its snapshots and figures are used
  std::filesystem::path run_folder;
  std::string name = {};                              ///< what the scene is called, where its file doesn't say
  AgainstSource against = {};                         ///< what is made beside it, to be held against
  const std::atomic<bool>* interrupted = nullptr;     ///< asks to stop after the frame in work
  std::function<void(int frame, int last)> progress;  ///< of a line that makes many frames, after each
};

/// Whether it changes what the next frame becomes, not only how it is seen.
bool changes_model(const Command& command);

class Debugger {
 public:
  /// Makes frame 0. Throws InputError.
  Debugger(const std::filesystem::path& scene, const std::vector<std::string>& overrides,
           const std::filesystem::path& script, const DebuggerOptions& options);

  /// Throws InputError for a line that can't be done whatever the frame.
  void check(const PlacedText& line);
  /// Reads a line and does it, unless it is the window's to do: input, shots and quit are handed back. Throws
  /// InputError.
  std::optional<DebugLine> execute(const PlacedText& line);
  /// The same for a line typed or clicked: what is wrong becomes a message in the console.
  std::optional<DebugLine> try_execute(const std::string& line);
  /// A line that comes while another is being done, at a pause of its computation: done at once where it leaves the model
  /// alone. False: it must wait.
  bool execute_meanwhile(const std::string& line);
  /// Makes the next frame while playing. False if it isn't.
  bool play_on();

  const DebugModel& model();
  const ViewSettings& view() const { return session_.view().settings(); }
  /// Of the frame, also in the middle of it.
  std::uint64_t state_hash() const { return hashes_[static_cast<std::size_t>(frame())]; }
  /// Of a run, or a bundle, that of the scene that it was made of.
  std::string scene_file_name() const { return session_.scene_file().filename().string(); }
  bool is_interrupted() const { return interrupted_ != nullptr && *interrupted_; }
  std::string note_of_former_paths() const { return session_.note_of_former_paths(); }
  int failures() const { return expectations_.failures(); }
  /// Says what the script expects beyond the frames that were made.
  void tell_unchecked() const { expectations_.tell_rest(static_cast<int>(hashes_.size()) - 1); }
  void say(ConsoleLine::Kind kind, const std::string& text);
  /// A file was written by that line.
  void record_file(const std::string& line) { add_recorded(line); }
  /// A picture was taken: with what was done, since it says where, and the pointer shows.
  void record_shot(const std::string& file, const UiPointer& pointer) { record_picture("shot " + file, pointer); }
  void record_bundle(const std::string& file, const UiPointer& pointer) { record_picture("bundle " + file, pointer); }
  /// Writes the last sub-step of the frame as it was handed to the response. Throws InputError where it can't.
  void freeze(const std::filesystem::path& file);
  /// All frames that are known, and says what there is to open; "" if it was interrupted. Throws InputError where the
  /// format can't take them, OutputError where they can't be written.
  std::string export_frames(const std::string& format, const std::filesystem::path& folder);
  void record_freeze(const std::string& file) { add_recorded("freeze " + file), trace_ = other; }
  /// The moment, for format_bundle; what was seen is for others to add. Throws InputError where a file that the scene reads
  /// can't be read any more.
  std::pair<BundleHead, std::map<std::string, std::string>> bundle(const UiPointer& pointer);
  /// To a moment that a bundle has, of which the folder is its run's; nothing of it is recorded.
  void open_at(const BundleHead& moment, const std::vector<std::string>& lines);
  /// What was done so far, as lines that do it again. `pointer`: where it is now, so that what it hovers over looks the
  /// same.
  std::vector<std::string> recording(const UiPointer& pointer) const;

 private:
  void do_command(const Command& command);
  void do_transport(const TransportLine& line);
  void do_select(Selection selection);
  void do_panel(const PanelLine& line);
  void do_break(const BreakLine& line);
  void take_back(const UndoLine& line);
  void exchange(Future& future);
  void find(const FindLine& line);
  void why(const WhyLine& line);
  void list_added();
  void check_added(const PlacedText& line, const DebugLine& parsed) const;
  void check_there(const PlacedText& line, const DebugLine& parsed) const;
  std::string absence_of(const std::string& body, bool is_act) const;
  std::vector<Command> commands_at(int frame) const;
  void tell_of_acts(int frame);
  bool do_by_hand(int frame);
  void show_by_hand();
  bool advance();
  void jump(int frame);
  void seek(int frame);
  void go_on(int frame);
  void step_within(TransportLine::Unit unit, int count);
  void back_within(TransportLine::Unit unit, int count);
  void stop_at(int frame, BreakHit hit);
  void restore_before(int frame);
  void reach(int frame);
  /// Where it stands: a frame, within which it may be at a stage.
  struct Within {
    int place = 0;
    StepRecord record;
  };
  int frame() const { return within_ ? stages_->frame : session_.frame(); }
  const StepRecord& shown() const { return within_ ? within_->record : session_.record(); }
  void remake(int frame, StepWatcher* watcher, FrozenStep* frozen = nullptr);
  const FrameStages& stages_of(int frame);
  void stand_in(int frame, int place);
  void look_through(int frame);
  std::vector<double> values_here(const Expression& condition);
  std::filesystem::path snapshot_file(int frame) const;
  std::optional<int> last_snapshot_before(int frame) const;
  void note_frame();
  void read_run_folder();
  bool bring_back(int frame);
  void check_hash(int frame);
  void record(const std::string& line);
  void record_transport(const std::string& line);
  void record_camera();
  void record_picture(const std::string& line, const UiPointer& pointer);
  std::vector<std::string> opening_lines() const;
  bool is_pending(int by_hand) const;
  std::string bundled_figures() const;
  void add_recorded(const std::string& line);
  void replace_recorded(const std::string& line);
  void follow_selection();
  void reach_against();
  void tell_of_against();

  const std::atomic<bool>* interrupted_;
  std::function<void(int, int)> progress_;
  Session session_;
  SnapshotRing ring_;
  ParameterSet start_;  // values before frame 0
  ParameterSet first_;  // and of it
  std::filesystem::path run_folder_;
  int folder_last_ = -1;                      // last frame up to which the folder's snapshots are of this run
  std::vector<std::vector<double>> history_;  // figures by frame
  std::vector<std::vector<double>> own_;      // values of the scene's own columns by frame
  std::vector<std::uint64_t> hashes_;         // by frame
  Tracks tracks_;
  std::map<int, std::vector<Command>> by_hand_;  // by the frame that shows them first
  std::set<int> changed_frames_;
  Edits edits_;
  DebugModel model_;
  ExpressionWords conditions_;
  Expectations expectations_;
  Breakpoints breaks_;
  std::set<std::string> announced_;  // bodies that lines which were checked will add
  ConditionReader reader_;
  std::optional<Against> against_;
  std::optional<FrameStages> stages_;  // of the frame looked into last
  std::optional<Within> within_;       // its making; none: at the end of a frame
  bool playing_ = false;
  bool stopped_ = false;    // the line being done was cut short by a `break`,
  bool was_ended_ = false;  // or by whoever did not want to wait
  std::vector<std::string> recorded_;
  std::vector<std::string> opened_;  // lines of the bundle that is looked at
  bool may_merge_ = false;           // whether the next line may become one with the last: nothing was said in between
  int known_before_ = 0;             // of the line being done: how many frames were known,
  std::size_t puts_ = 0, puts_before_ = 0;                // and how many states had been kept
  enum Trace { none, new_frames, other } trace_ = other;  // that the last line about frames left
  bool told_of_hash_ = false, told_of_missing_ = false, told_of_b_ = false;
};

}  // namespace impinge
