#include <fmt/format.h>

#include <cmath>

#include "engine/core/units.hpp"
#include "engine/geometry/mend/decimate.hpp"
#include "engine/geometry/mend/mend.hpp"

namespace impinge {
namespace {

std::string counted(int count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace

bool MendReport::is_changed() const { return !steps().empty(); }

std::vector<std::string> MendReport::steps() const {
  std::vector<std::string> lines;
  const auto step = [&](int count, auto&& text) {
    if (count > 0) lines.push_back(text());
  };
  step(welded, [&] {
    return fmt::format("welded {} to others", welded == 1 ? "1 vertex" : fmt::format("{} vertices", welded));
  });
  step(split_edges,
       [&] { return fmt::format("split {} at vertices of others that run along it", counted(split_edges, "edge")); });
  step(collapsed, [&] { return fmt::format("dropped {} without area", counted(collapsed, "triangle")); });
  step(duplicates, [&] { return fmt::format("dropped {} that lay on others", counted(duplicates, "triangle")); });
  step(joined, [&] { return fmt::format("drew {} without length together", counted(joined, "edge")); });
  step(flipped_flat,
       [&] { return fmt::format("flipped {} whose corners lie on a line", counted(flipped_flat, "triangle")); });
  step(turned, [&] { return fmt::format("turned {} to face as their neighbours", counted(turned, "triangle")); });
  step(cut_edges, [&] {
    return fmt::format("took sheets apart at {} ({} added)", counted(cut_edges, "edge"),
                       added_vertices == 1 ? "1 vertex" : fmt::format("{} vertices", added_vertices));
  });
  step(cut_edges == 0 ? added_vertices : 0,
       [&] { return fmt::format("took sheets apart at vertices ({} added)", added_vertices); });
  step(holes,
       [&] { return fmt::format("filled {} with {}", counted(holes, "hole"), counted(hole_triangles, "triangle")); });
  step(flat_parts, [&] {
    return fmt::format("dropped {} that {} flat", counted(flat_parts, "part"), flat_parts == 1 ? "is" : "are");
  });
  step(turned_parts, [&] { return fmt::format("turned {} to face outwards", counted(turned_parts, "part")); });
  step(inner_parts, [&] { return fmt::format("dropped {} inside of others", counted(inner_parts, "part")); });
  step(sheets, [&] { return fmt::format("gave {} a thickness", counted(sheets, "open part")); });
  step(remeshed ? 1 : 0, [&] { return std::string("made a new skin round it"); });
  return lines;
}

std::string DecimateReport::text() const {
  const double change = volume_before != 0.0 ? 100.0 * (volume_after - volume_before) / volume_before : 0.0;
  return fmt::format("{} of {} triangles, up to {} apart, volume {}", triangles_after, triangles_before,
                     length_text(farthest), std::abs(change) < 1e-6 ? "kept" : fmt::format("{:+.2g} %", change));
}

}  // namespace impinge
