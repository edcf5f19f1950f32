// What the debugger's panels show, as plain data. They change nothing themselves: what is done in them comes out as
// command lines.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/parameter.hpp"
#include "engine/world/stage_place.hpp"
#include "viewer/draw/view_settings.hpp"

namespace impinge {

/// What was picked. A contact is found again in later frames by its pair_id.
struct Selection {
  enum Kind { none, body, contact };
  Kind kind = none;
  int index = -1;             ///< of the body or contact in the record
  int triangle = -1;          ///< of a body's surface, -1: none
  std::uint64_t pair_id = 0;  ///< of a contact
  bool is_there() const { return kind != none && index >= 0; }
};

/// The panels' own state. Only commands change it, so a recording holds it.
struct PanelState {
  std::string sort = "gap";  ///< column of the contact table
  bool descending = false;
  std::set<std::string> folded;  ///< groups of parameters
  std::string filter;            ///< of parameters
  /// columns of stats.csv in the timeline
  std::vector<std::string> plots = {"contacts", "max_penetration_m", "kinetic_J"};
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
  const ViewSettings* view = nullptr;
  std::string scene;
  int frame = 0, known_last = 0;
  bool playing = false;
  /// In the middle of the making of the frame, and where; null: at its end.
  const FrameStages* stages = nullptr;
  int place = 0;
  const std::vector<std::string>* figure_names = nullptr;
  const std::vector<std::vector<double>>* history = nullptr;  ///< figures by frame
  const std::set<int>* changed_frames = nullptr;              ///< with commands by hand
  std::size_t snapshots = 0, snapshot_bytes = 0, most_snapshot_bytes = 0;
  Selection selection;
  PanelState state;
  std::vector<ConsoleLine> console;

  /// Of the frame shown, by its column's name; 0 if there is none.
  double figure(std::string_view column) const {
    const auto it = std::find(figure_names->begin(), figure_names->end(), column);
    return it == figure_names->end()
               ? 0.0
               : (*history)[static_cast<std::size_t>(frame)][static_cast<std::size_t>(it - figure_names->begin())];
  }
};

/// Columns that the contact table sorts by, as commands name them.
const std::vector<std::string>& contact_columns();

}  // namespace impinge
