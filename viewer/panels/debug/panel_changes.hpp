// Which panels look otherwise than in the frame before: the others are left as they were drawn, since drawing all of
// them takes the processor longer than anything else in a frame whose scene stands still.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "viewer/panels/debug/ui.hpp"

struct ImDrawData;
struct ImDrawList;

namespace impinge {

struct PanelDrawing {
  UiArea area;
  std::vector<const ImDrawList*> lists;
};

class PanelChanges {
 public:
  /// What has to be drawn, each where nothing else is. Nothing if all of the window has to be: something lies over
  /// several panels or the view, or did so in the frame before.
  std::optional<std::vector<PanelDrawing>> next(const ImDrawData& data, std::span<const UiArea> areas);
  /// The next frame is to be drawn as a whole.
  void forget() { last_.clear(); }

 private:
  std::vector<std::uint64_t> last_;  // of each area's lists; none: not known
};

}  // namespace impinge
