#include "viewer/report/pair_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/parameter.hpp"
#include "viewer/report/json_values.hpp"
#include "viewer/report/parts.hpp"

namespace impinge {
namespace {

std::string vector_text(const Vec3& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

std::string place_text(int frame, int substep) {
  return substep == 0 ? fmt::format("frame {}", frame) : fmt::format("frame {}, sub-step {}", frame, substep);
}
std::string place_text(const PairWatch::Moment& at) { return place_text(at.frame, at.substep); }

std::string unsafe_text(const PairWatch& watch) {
  if (watch.unsafe_motions() == 0) return "";
  return fmt::format("; may have passed each other in {} sub-step{}, the first in {}", watch.unsafe_motions(),
                     watch.unsafe_motions() == 1 ? "" : "s", place_text(*watch.first_unsafe()));
}

std::string history_text(const PairWatch& watch, int last_frame) {
  const std::string frames = last_frame == 0 ? "frame 0" : fmt::format("frames 0 to {}", last_frame);
  if (const auto first = watch.first_contact()) {
    if (watch.contacts() == 1) return fmt::format("a contact in {} alone, of {}", place_text(*first), frames);
    return fmt::format("contacts in {} sub-steps of {}, the first in {}, the last in {}", watch.contacts(), frames,
                       place_text(*first), place_text(*watch.last_contact()));
  }
  const auto nearest = watch.nearest_miss();
  if (!nearest) return fmt::format("never in contact in {}", frames);
  const double distance = watch.nearest_distance();
  return fmt::format("never in contact in {}; {} {:.4g} m {} in {}", frames, distance < 0.0 ? "deepest" : "nearest",
                     std::abs(distance), distance < 0.0 ? "within each other" : "apart", place_text(*nearest));
}

std::string box_json(const Aabb& box) {
  return fmt::format("{{\"min\": {}, \"max\": {}}}", json_vector(box.min), json_vector(box.max));
}
std::string moment_json(const std::optional<PairWatch::Moment>& at) {
  return at ? fmt::format("{{\"frame\": {}, \"substep\": {}}}", at->frame, at->substep) : "null";
}
std::string triangle_json(TriangleIndex triangle) { return fmt::format("{}", triangle.value()); }

std::string feature_json(Feature kind, int index) {
  constexpr std::string_view kNames[] = {"vertex", "edge", "face", "shape"};
  return fmt::format("{{\"kind\": \"{}\", \"index\": {}}}", kNames[static_cast<int>(kind)], index);
}

std::string body_json(const std::string& name, BodyKind kind, const std::string& shape, const Aabb& box,
                      const Aabb& swept) {
  return fmt::format("{{\"name\": {}, \"kind\": \"{}\", \"shape\": \"{}\", \"box_m\": {}, \"swept_box_m\": {}}}",
                     json_text(name), kind_name(kind), shape, box_json(box), box_json(swept));
}

std::string filter_json(const FilterVerdict& filter) {
  std::string numbers;
  for (const NamedNumber& n : filter.numbers)
    numbers += fmt::format("{}\"{}\": {}", numbers.empty() ? "" : ", ", n.name, json_number(n.value));
  return fmt::format("{{\"filter\": \"{}\", \"outcome\": \"{}\", \"words\": {}, \"numbers\": {{{}}}}}", filter.filter,
                     name_of(filter.outcome), json_text(filter.words), numbers);
}

std::string nearest_json(const PairVerdict& v) {
  if (!v.nearest) return "null";
  const NearestFeatures& n = *v.nearest;
  return fmt::format(
      "{{\"distance_m\": {}, \"point_a\": {}, \"point_b\": {}, \"normal\": {}, \"triangle_a\": {}, \"triangle_b\": {}, "
      "\"feature_a\": {}, \"feature_b\": {}}}",
      json_number(n.distance), json_vector(n.point_a), json_vector(n.point_b), json_vector(n.normal),
      triangle_json(n.triangle_a), triangle_json(n.triangle_b), feature_json(n.kind_a, n.index_a),
      feature_json(n.kind_b, n.index_b));
}

std::string contact_json(const Collision& c) {
  return fmt::format(
      "{{\"triangle_a\": {}, \"triangle_b\": {}, \"point_a\": {}, \"point_b\": {}, \"normal\": {}, \"gap_m\": {}, "
      "\"pair_id\": \"{}\"}}",
      triangle_json(c.triangle_a), triangle_json(c.triangle_b), json_vector(c.point_a), json_vector(c.point_b),
      json_vector(c.normal), json_number(c.gap), c.feature);
}

template <class List, class Format>
std::string lines_json(const List& list, Format format) {
  std::string out;
  for (const auto& item : list) out += (out.empty() ? "\n    " : ",\n    ") + format(item);
  return out.empty() ? "[]" : "[" + out + "\n  ]";
}

}  // namespace

std::string pair_text(const PairWatch& watch, int last_frame) {
  const PairVerdict& v = *watch.verdict();
  std::string text;
  const auto line = [&](std::string_view label, const std::string& words) {
    text += fmt::format("{:<15}{}\n", label, words);
  };
  const std::string pair = v.a == v.b
                               ? fmt::format("'{}' ({}, {}) with itself", v.name_a, kind_name(v.kind_a), v.shape_a)
                               : fmt::format("'{}' ({}, {}) and '{}' ({}, {})", v.name_a, kind_name(v.kind_a),
                                             v.shape_a, v.name_b, kind_name(v.kind_b), v.shape_b);
  line("pair", pair);
  std::string moment = place_text(v.frame, v.substep);
  if (v.substep > 0) moment += fmt::format(" of {}", v.substeps);
  moment += fmt::format(": contacts sought at {:.6g} s", v.time);
  if (v.pieces > 1)
    moment += v.piece == v.pieces
                  ? fmt::format(", in the last of {} pieces", v.pieces)
                  : fmt::format(", in piece {} of {}, the last that they pushed each other in", v.piece, v.pieces);
  line("moment", moment);
  const FilterVerdict* stop = v.stopped_by();
  line("verdict",
       v.in_contact()
           ? fmt::format("in contact, {} contact{}", v.contacts.size(), v.contacts.size() == 1 ? "" : "s")
           : fmt::format("no contact{}", stop == nullptr ? "" : fmt::format(", stopped by {}", stop->filter)));
  line("history", history_text(watch, last_frame) + unsafe_text(watch));
  text += "\n";
  for (const FilterVerdict& filter : v.filters)
    text += filter.words.empty()
                ? fmt::format("{:<15}{}\n", filter.filter, name_of(filter.outcome))
                : fmt::format("{:<15}{:<10} {}\n", filter.filter, name_of(filter.outcome), filter.words);
  if (v.nearest) {
    text += "\n";
    line("nearest on A", fmt::format("{} of '{}'", vector_text(v.nearest->point_a), v.name_a));
    line("nearest on B", fmt::format("{} of '{}'", vector_text(v.nearest->point_b), v.name_b));
    line("normal", fmt::format("{} from B to A", vector_text(v.nearest->normal)));
  }
  return text;
}

std::string pair_json(const PairWatch& watch, int last_frame) {
  const PairVerdict& v = *watch.verdict();
  const FilterVerdict* stop = v.stopped_by();
  std::string text = "{\n";
  const auto field = [&](std::string_view name, const std::string& value, bool is_last = false) {
    text += fmt::format("  \"{}\": {}{}\n", name, value, is_last ? "" : ",");
  };
  field("body_a", body_json(v.name_a, v.kind_a, v.shape_a, v.box_a, v.swept_a));
  field("body_b", body_json(v.name_b, v.kind_b, v.shape_b, v.box_b, v.swept_b));
  field("frame", fmt::format("{}", v.frame));
  field("substep", fmt::format("{}", v.substep));
  field("substeps", fmt::format("{}", v.substeps));
  field("pieces", fmt::format("{}", v.pieces));
  field("piece", fmt::format("{}", v.piece));
  field("time_s", json_number(v.time));
  field("time_step_s", json_number(v.time_step));
  field("in_contact", v.in_contact() ? "true" : "false");
  field("stopped_by", v.in_contact() || stop == nullptr ? "null" : fmt::format("\"{}\"", stop->filter));
  field("filters", lines_json(v.filters, filter_json));
  field("nearest", nearest_json(v));
  field("contacts", lines_json(v.contacts, contact_json));
  text += "  \"history\": {\n";
  text += fmt::format("    \"first_frame\": 0,\n    \"last_frame\": {},\n    \"substeps_with_contacts\": {},\n",
                      last_frame, watch.contacts());
  text += fmt::format("    \"first_contact\": {},\n    \"last_contact\": {},\n", moment_json(watch.first_contact()),
                      moment_json(watch.last_contact()));
  text += fmt::format("    \"unsafe_motions\": {},\n    \"first_unsafe\": {},\n", watch.unsafe_motions(),
                      moment_json(watch.first_unsafe()));
  const auto miss = watch.first_contact() ? std::nullopt : watch.nearest_miss();
  text += fmt::format("    \"nearest_miss\": {}\n  }}\n",
                      miss ? fmt::format("{{\"frame\": {}, \"substep\": {}, \"distance_m\": {}}}", miss->frame,
                                         miss->substep, json_number(watch.nearest_distance()))
                           : "null");
  return text + "}\n";
}

}  // namespace impinge
