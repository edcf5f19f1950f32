// Letters of a window by what Dear ImGui draws: those that its clip rectangles cut through, and those that lie over
// another one.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <vector>

#include "viewer/panels/debug/ui.hpp"

namespace impinge::test {

struct TextFaults {
  int letters = 0, cut_off = 0, over_others = 0;
};

/// Of the letters in that area. A row that is half scrolled away is none: only what is cut at its left or right counts.
inline TextFaults text_faults(const ImDrawData& data, const UiArea& area) {
  struct Letter {
    float left, top, right, bottom;
  };
  std::vector<Letter> letters;
  TextFaults faults;
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      // two triangles of four vertices; a letter's have their own places in the font's picture
      for (unsigned i = 0; i + 6 <= command.ElemCount; i += 3) {
        const auto vertex = [&](unsigned k) -> const ImDrawVert& {
          return list.VtxBuffer[static_cast<int>(command.VtxOffset +
                                                 list.IdxBuffer[static_cast<int>(command.IdxOffset + i + k)])];
        };
        const ImDrawVert &a = vertex(0), &b = vertex(1), &c = vertex(2);
        if (vertex(3).pos.x != a.pos.x || vertex(3).pos.y != a.pos.y || (a.uv.x == c.uv.x && a.uv.y == c.uv.y))
          continue;
        i += 3;
        Letter letter{std::min(a.pos.x, c.pos.x), std::min(a.pos.y, c.pos.y), std::max(b.pos.x, c.pos.x),
                      std::max(b.pos.y, c.pos.y)};
        if (!area.holds(letter.left, letter.top)) continue;
        const ImVec4& clip = command.ClipRect;
        if (letter.bottom <= clip.y || letter.top >= clip.w || letter.right <= clip.x || letter.left >= clip.z)
          continue;
        ++faults.letters;
        faults.cut_off += letter.left < clip.x - 0.5f || letter.right > clip.z + 0.5f;
        letter.top = std::max(letter.top, clip.y), letter.bottom = std::min(letter.bottom, clip.w);
        for (const Letter& other : letters) {
          const float wide = std::min(letter.right, other.right) - std::max(letter.left, other.left),
                      high = std::min(letter.bottom, other.bottom) - std::max(letter.top, other.top);
          if (wide > 1.0f && high > 1.0f) {
            ++faults.over_others;
            break;
          }
        }
        letters.push_back(letter);
      }
    }
  }
  return faults;
}

}  // namespace impinge::test
