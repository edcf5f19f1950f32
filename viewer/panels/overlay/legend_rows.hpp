// What a legend has to say of a picture, before anything is known of the room for it.
#pragma once

#include <string>
#include <vector>

#include "viewer/layers/layer.hpp"

namespace impinge {

struct ShownRow {
  LegendRow::Mark mark = LegendRow::area;
  Color color;
  std::string text;
  std::string quantity = {};  ///< what the mark stands for, alone; "": for nothing that has a size
  float size = 0.0f;          ///< pixels: an arrow's length, a disc's diameter; 0: as marks of legends are
  bool is_cut = false;        ///< an arrow with two heads
};

/// `pixel_scale`: of the marks in the picture. Marks with a size have one between `least` and `most`, where such a one
/// can be had of an amount as round.
std::vector<ShownRow> legend_rows(const StepRecord& record, const DrawList& list, const ViewSettings& settings,
                                  float pixel_scale, float least, float most);

}  // namespace impinge
