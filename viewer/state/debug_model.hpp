// What the debugger's panels show, as plain data. They change nothing themselves: what is done in them comes out as
// command lines.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/parameter.hpp"
#include "engine/step/act.hpp"
#include "engine/world/stage_place.hpp"
#include "viewer/draw/view_settings.hpp"
#include "viewer/state/against_model.hpp"
#include "viewer/state/tracks.hpp"

namespace impinge {

/// What was picked. A contact is found again in later frames by its pair_id.
struct Selection {
  enum Kind { none, body, contact };
  Kind kind = none;
  int index = -1;             ///< of the body or contact in the record, -1: not there in this frame
  int place = -1;             ///< of a body, among all that there are or will be
  int triangle = -1;          ///< of a body's surface, -1: none
  std::uint64_t pair_id = 0;  ///< of a contact
  bool is_there() const { return kind != none && index >= 0; }
};

/// How one looks at a table of a panel.
struct TableState {
  std::string sort = {};  ///< column; "": as the scene has the rows
  bool descending = false;
  std::vector<std::string> columns = {};  ///< in the order in which they were chosen; none: those at first
};

/// The panels' own state. Only commands change it, so a recording holds it.
struct PanelState {
  std::map<std::string, TableState, std::less<>> tables = {{"contacts", {"gap"}}};
  std::string tab = "bodies";                ///< of the outliner
  std::string search;                        ///< in the outliner
  std::map<std::string, std::string> front;  ///< of panels that share a room: by the one that owns it, who is seen
  bool is_selected_sought = false;           ///< whether the selected row has still to be scrolled to
  std::set<std::string> folded;              ///< groups of parameters
  std::string filter;                        ///< of parameters
  /// in the timeline: columns of stats.csv, and figures of bodies and pairs (tracks.hpp)
  std::vector<std::string> plots = {"contacts", "max_penetration_m", "kinetic_J"};
  bool log_plots = false;               ///< the axis of plots is logarithmic
  bool trails = false;                  ///< of bodies in the view
  int ghost = -1;                       ///< frame that is seen through the present one; none: -1
  std::map<std::string, float> scroll;  ///< by panel, pixels
  bool help = false;
};

/// A line of the console.
struct ConsoleLine {
  enum Kind { command, message, problem };
  Kind kind = command;
  std::string text;
};

struct DebugModel {
  const StepRecord* record = nullptr;
  const ParameterSet* rows = nullptr;
  std::size_t rows_present = 0;  ///< of them, but for those of bodies that are still to be added, which come last
  const ViewSettings* view = nullptr;
  std::string scene;
  int frame = 0, known_last = 0;
  bool playing = false;
  double computing = 0.0;  ///< seconds that the frame after this one has taken by now; 0: nothing is being computed
  /// In the middle of the making of the frame, and where; null: at its end.
  const FrameStages* stages = nullptr;
  int place = 0;
  const std::vector<std::string>* figure_names = nullptr;
  const std::vector<std::vector<double>>* history = nullptr;  ///< figures by frame
  const Tracks* tracks = nullptr;
  const AgainstModel* against = nullptr;                           ///< what is made beside it; null: nothing
  const std::set<int>* changed_frames = nullptr;                   ///< with commands
  std::function<std::vector<std::string>(int frame)> commands_of;  ///< which
  std::size_t snapshots = 0, snapshot_bytes = 0, most_snapshot_bytes = 0;
  std::vector<Act> asked;  ///< of bodies by hand, for the next frame
  struct Coming {
    BodyRecord body;   ///< as it will begin
    std::string like;  ///< the body that it is a copy of
  };
  std::vector<Coming> coming;  ///< bodies that are added then
  Selection selection;
  PanelState state;
  std::vector<ConsoleLine> console;

  std::vector<std::string> bodies() const {
    std::vector<std::string> names;
    for (const BodyRecord& body : record->bodies) names.emplace_back(body.name);
    return names;
  }

  /// Of the frame shown, by its column's name; 0 if there is none.
  double figure(std::string_view column) const {
    const auto it = std::find(figure_names->begin(), figure_names->end(), column);
    return it == figure_names->end()
               ? 0.0
               : (*history)[static_cast<std::size_t>(frame)][static_cast<std::size_t>(it - figure_names->begin())];
  }
};

}  // namespace impinge
