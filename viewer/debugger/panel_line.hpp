// Lines about the panels themselves: what of them is seen, and in which order.
//
//   panel sort [TABLE] COLUMN [down] | columns TABLE +COLUMN -COLUMN      of contacts, bodies, groups, pairs
//   panel plot +COLUMN -COLUMN | axis log|linear      a column of stats.csv, or a figure of a body or pair: gap(a,b)
//   panel fold GROUP | unfold GROUP | filter [TEXT]
//   panel search [TEXT] | tab bodies|groups|pairs                         of the outliner
//   panel trails on|off | ghost FRAME|off                                 in the view
//   panel front PANEL | scroll PANEL PIXELS | help on|off
#pragma once

#include "engine/core/parameter.hpp"
#include "viewer/debugger/line_words.hpp"
#include "viewer/state/debug_model.hpp"

namespace impinge {

struct PanelLine {
  enum Verb { sort, fold, unfold, plot, filter, scroll, help, columns_of, search, tab, front, axis, trails, ghost };
  Verb verb = sort;
  std::string name;                                   ///< column, group, text, tab or panel
  std::string table;                                  ///< sort, columns_of
  bool on = false;                                    ///< sort: down; help; axis: logarithmic
  float pixels = 0.0f;                                ///< scroll
  int frame = -1;                                     ///< ghost
  std::vector<std::pair<std::string, bool>> columns;  ///< plot, columns_of
};
/// `figures`: columns of stats.csv. Throws InputError at the word that is wrong.
PanelLine parse_panel(const PlacedText& line, LineWords words, const ParameterSet& rows,
                      const std::vector<std::string>& figures);

/// What a panel line makes of the panels.
void take(const PanelLine& line, PanelState& p);

}  // namespace impinge
