#include "viewer/panels/debug/panel_changes.hpp"

#include <imgui.h>

#include <algorithm>

#include "engine/core/archive.hpp"

namespace impinge {
namespace {

template <class T>
std::uint64_t hash_of(const ImVector<T>& items, std::uint64_t seed) {
  return hash_bytes({reinterpret_cast<const char*>(items.Data), static_cast<std::size_t>(items.Size) * sizeof(T)},
                    seed);
}

/// Whether all that it draws is: what its clip rectangles leave of its triangles. (A panel's background has the whole
/// window's.)
bool is_within(const ImDrawList& list, const UiArea& area) {
  for (const ImDrawCmd& c : list.CmdBuffer) {
    const bool clipped = c.ClipRect.x >= area.x && c.ClipRect.y >= area.y && c.ClipRect.z <= area.x + area.width &&
                         c.ClipRect.w <= area.y + area.height;
    for (unsigned i = 0; i < c.ElemCount && !clipped; ++i) {
      const ImVec2& p =
          list.VtxBuffer[static_cast<int>(c.VtxOffset + list.IdxBuffer[static_cast<int>(c.IdxOffset + i)])].pos;
      if (p.x < area.x || p.y < area.y || p.x > area.x + area.width || p.y > area.y + area.height) return false;
    }
  }
  return true;
}

std::uint64_t hash_of(const ImDrawList& list, std::uint64_t seed) {
  seed = hash_of(list.IdxBuffer, hash_of(list.VtxBuffer, seed));
  for (const ImDrawCmd& c : list.CmdBuffer) {
    ByteWriter bytes;
    for (const float v : {c.ClipRect.x, c.ClipRect.y, c.ClipRect.z, c.ClipRect.w}) bytes.put(v);
    bytes.put(c.ElemCount), bytes.put(c.IdxOffset), bytes.put(c.VtxOffset);
    seed = hash_bytes(bytes.bytes(), seed);
  }
  return seed;
}

}  // namespace

std::optional<std::vector<PanelDrawing>> PanelChanges::next(const ImDrawData& data, std::span<const UiArea> areas) {
  std::vector<PanelDrawing> drawings;
  std::vector<std::uint64_t> hashes(areas.size(), 1);
  for (const UiArea& area : areas) drawings.push_back({area, {}});
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    const auto it = std::find_if(areas.begin(), areas.end(), [&](const UiArea& area) { return is_within(list, area); });
    if (it == areas.end()) {
      last_.clear();  // what is below it comes back only with all
      return std::nullopt;
    }
    const auto k = static_cast<std::size_t>(it - areas.begin());
    drawings[k].lists.push_back(&list);
    hashes[k] = hash_of(list, hashes[k]);
  }
  last_.swap(hashes);
  if (hashes.size() != last_.size()) return std::nullopt;
  std::vector<PanelDrawing> changed;
  for (std::size_t k = 0; k < last_.size(); ++k)
    if (hashes[k] != last_[k]) changed.push_back(std::move(drawings[k]));
  return changed;
}

}  // namespace impinge
