// The list of the debugger's panels: one line each, in the order of drawing and, in each place, of standing.
#include "engine/core/registry.hpp"
#include "viewer/panels/debug/panel.hpp"

namespace impinge {

const std::vector<Panel>& panels() {
  static const std::vector<Panel> list = [] {
    std::vector<Panel> all;
    IMPINGE_LIST(all, layers_panel);
    IMPINGE_LIST(all, parameters_panel);
    IMPINGE_LIST(all, outliner_panel);
    IMPINGE_LIST(all, inspector_panel);
    IMPINGE_LIST(all, contacts_panel);
    IMPINGE_LIST(all, ledger_panel);
    IMPINGE_LIST(all, stages_panel);
    IMPINGE_LIST(all, transport_panel);
    IMPINGE_LIST(all, timeline_panel);
    IMPINGE_LIST(all, console_panel);
    return all;
  }();
  return list;
}

}  // namespace impinge
