#include "engine/world/figures.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {

namespace {

using enum FigureKind;
using S = FrameStats;
using T = StageTimes;

// The order is a contract: a new column is one line, the last. Sums and maxima are over the frame's sub-steps.
constexpr Figure kFigures[] = {
    {"frame", "", state, &S::frame, "Number of the frame; 0 is the state as loaded."},
    {"time_s", "s", state, &S::time, "Time at the end of the frame."},
    {"substeps", "", state, &S::substeps, "Sub-steps of the frame."},
    {"bodies", "", state, &S::bodies, "Bodies of the scene that are not deleted."},
    {"dofs", "", state, &S::dofs, "Degrees of freedom without constraints, sleeping bodies included."},
    {"broad_pairs", "", state, &S::broad_pairs, "Pairs of bodies that the broad phase let through, last sub-step."},
    {"triangle_pairs", "", state, &S::triangle_pairs, "Pairs of triangles that meet or are near, last sub-step."},
    {"contacts", "", state, &S::contacts, "Contacts handed to the response, last sub-step."},
    {"groups", "", state, &S::groups, "Collision groups, last sub-step."},
    {"max_penetration_m", "m", state, &S::max_penetration,
     "Largest overlap at the end of the frame, of meshes by vertices, by edges where none is inside."},
    {"residual", "m/s", state, &S::residual, "Largest residual of the frame's solves, by the judge of responses."},
    {"lcp_iterations", "", state, &S::lcp_iterations, "Iterations of solvers and sweeps, summed."},
    {"outer_iterations", "", state, &S::outer_iterations, "Outer iterations of the responses that have some, summed."},
    {"kinetic_J", "J", state, &S::kinetic, "Kinetic energy."},
    {"potential_J", "J", state, &S::potential, "Potential energy: -m g x, summed over the bodies."},
    {"elastic_J", "J", state, &S::elastic, "Elastic energy of deformable bodies."},
    {"momentum_x", "kg m/s", state, VectorFigure{&S::momentum, 0}, "Momentum of all bodies."},
    {"momentum_y", "kg m/s", state, VectorFigure{&S::momentum, 1}, "Momentum of all bodies."},
    {"momentum_z", "kg m/s", state, VectorFigure{&S::momentum, 2}, "Momentum of all bodies."},
    {"angular_momentum_x", "kg m²/s", state, VectorFigure{&S::angular_momentum, 0},
     "Angular momentum about the origin."},
    {"angular_momentum_y", "kg m²/s", state, VectorFigure{&S::angular_momentum, 1},
     "Angular momentum about the origin."},
    {"angular_momentum_z", "kg m²/s", state, VectorFigure{&S::angular_momentum, 2},
     "Angular momentum about the origin."},
    {"broad_ms", "ms", time, &T::broad_ms, "Broad phase, summed."},
    {"narrow_ms", "ms", time, &T::narrow_ms, "Narrow phase, summed."},
    {"assemble_ms", "ms", time, &T::assemble_ms, "Groups and their systems, summed."},
    {"response_ms", "ms", time, &T::response_ms, "Response, summed."},
    {"integrate_ms", "ms", time, &T::integrate_ms, "Forces, factorizations and motion, summed."},
    {"step_ms", "ms", time, &T::step_ms, "The whole step."},
    {"render_ms", "ms", time, &T::render_ms, "The picture, without writing it."},
    {"state_hash", "", state, &S::state_hash, "16 hex digits over all that makes the next frame."},
    {"unconverged", "", state, &S::unconverged, "Group solves that ended at the cap on iterations."},
    {"asleep", "", state, &S::asleep, "Bodies that sleep."},
    {"judged_penetration_m", "m", judged, &S::judged_penetration,
     "Deepest vertex of a body inside another, found without detection; edges that cross are in judged_depth_m."},
    {"judged_intersections", "", judged, &S::judged_intersections,
     "Pairs of triangles of two bodies that share a point."},
    {"substep_penetration_m", "m", state, &S::substep_penetration,
     "Largest overlap of a contact at the end of any sub-step of the frame."},
    {"unsafe_motions", "", state, &S::unsafe_motions,
     "Bodies that passed another, or moved farther in a sub-step than contacts see."},
    {"self_crossings", "", state, &S::self_crossings,
     "Crossing pairs of triangles of deformable bodies' own surfaces: of those with self_collision, with --judge of "
     "all, "
     "with --judge=substeps the most of any sub-step."},
    {"residual_coulomb", "", state, &S::residual_coulomb,
     "Largest natural map of the frame's solves, as a share of the velocity that its group's contacts ask for."},
    {"ended", "", state, &S::ended,
     "Why the worst of the frame's solves ended (the numbers 0 to 5): converged, cap, stalled, contradiction, "
     "refused; fixed: the method makes so many sweeps in any case and claims nothing, residual_coulomb says how far "
     "they came."},
    {"attachment_error_m", "m", state, &S::attachment_error,
     "Largest distance of an attached point from where it is held, at the end of the frame."},
    {"guard_ms", "ms", time, &T::guard_ms,
     "Looks back at motions for what passed, and keeping what undoes them, summed."},
    {"judged_depth_m", "m", judged, &S::judged_depth,
     "Largest overlap of bodies, found without detection: vertices, edges between them, and what lies half way through "
     "bodies that coincide."},
};

// By the type of what the source points to; one that is made of others has no place of its own.
struct Value {
  const S& s;
  double operator()(int S::*m) const { return s.*m; }
  double operator()(std::int64_t S::*m) const { return static_cast<double>(s.*m); }
  double operator()(double S::*m) const { return s.*m; }
  double operator()(const VectorFigure& part) const { return (s.*part.vector)[part.axis]; }
  double operator()(double T::*m) const { return s.times.*m; }
  double operator()(std::uint64_t S::*) const { return 0.0; }
  double operator()(SolveEnd S::*m) const { return static_cast<double>(s.*m); }
  double operator()(double (*made_of)(const S&)) const { return made_of(s); }
};

struct Put {
  ByteWriter& out;
  const S& s;
  void operator()(int S::*m) const { out.put<std::int64_t>(s.*m); }
  void operator()(std::int64_t S::*m) const { out.put(s.*m); }
  void operator()(double S::*m) const { out.put(s.*m); }
  void operator()(const VectorFigure& part) const { out.put((s.*part.vector)[part.axis]); }
  void operator()(double T::*m) const { out.put(s.times.*m); }
  void operator()(std::uint64_t S::*m) const { out.put(s.*m); }
  void operator()(SolveEnd S::*m) const { out.put(static_cast<std::uint8_t>(s.*m)); }
  void operator()(double (*)(const S&)) const {}
};

struct Get {
  ByteReader& in;
  S& s;
  void operator()(int S::*m) const { s.*m = static_cast<int>(in.get<std::int64_t>()); }
  void operator()(std::int64_t S::*m) const { s.*m = in.get<std::int64_t>(); }
  void operator()(double S::*m) const { s.*m = in.get<double>(); }
  void operator()(const VectorFigure& part) const { (s.*part.vector)[part.axis] = in.get<double>(); }
  void operator()(double T::*m) const { s.times.*m = in.get<double>(); }
  void operator()(std::uint64_t S::*m) const { s.*m = in.get<std::uint64_t>(); }
  void operator()(SolveEnd S::*m) const {
    const auto number = in.get<std::uint8_t>();
    if (number >= std::size(kSolveEnds))
      throw InputError("snapshot: why solves ended is no known number; it is damaged, remove it and run again");
    s.*m = kSolveEnds[number];
  }
  void operator()(double (*)(const S&)) const {}
};

bool is_kept(const Figure& figure) {
  return figure.kind == state && !std::holds_alternative<double (*)(const S&)>(figure.source);
}

bool is_number(const Figure& figure, bool with_judged) {
  return !figure.is_hash() && (with_judged || figure.kind != judged);
}

}  // namespace

std::string_view kind_name(FigureKind kind) {
  constexpr std::string_view kNames[] = {"state", "time", "judged"};
  return kNames[static_cast<int>(kind)];
}

double Figure::value(const FrameStats& stats) const { return std::visit(Value{stats}, source); }

std::span<const Figure> figures() { return kFigures; }

const Figure* find_figure(std::string_view name) {
  const auto* it =
      std::find_if(std::begin(kFigures), std::end(kFigures), [&](const Figure& f) { return f.name == name; });
  return it == std::end(kFigures) ? nullptr : it;
}

const std::vector<std::string>& figure_names(bool judged) {
  const auto names = [](bool with) {
    std::vector<std::string> list;
    for (const Figure& figure : kFigures)
      if (is_number(figure, with)) list.emplace_back(figure.name);
    return list;
  };
  static const std::vector<std::string> plain = names(false), all = names(true);
  return judged ? all : plain;
}

std::vector<double> figure_values(const FrameStats& stats, bool judged) {
  std::vector<double> values;
  for (const Figure& figure : kFigures)
    if (is_number(figure, judged)) values.push_back(figure.value(stats));
  return values;
}

const Figure* first_not_finite(const FrameStats& stats, bool judged) {
  const auto found = std::find_if(std::begin(kFigures), std::end(kFigures), [&](const Figure& figure) {
    return (judged || figure.kind != FigureKind::judged) && !std::isfinite(figure.value(stats));
  });
  return found == std::end(kFigures) ? nullptr : found;
}

std::size_t figure_index(std::string_view name, bool judged) {
  const std::vector<std::string>& names = figure_names(judged);
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) throw InternalError("no figure is named '" + std::string(name) + "'");
  return static_cast<std::size_t>(it - names.begin());
}

void put_figures(ByteWriter& out, const FrameStats& stats) {
  out.put<std::uint64_t>(static_cast<std::uint64_t>(std::ranges::count_if(kFigures, is_kept)));
  for (const Figure& figure : kFigures)
    if (is_kept(figure)) std::visit(Put{out, stats}, figure.source);
}

void get_figures(ByteReader& in, FrameStats& stats) {
  auto left = in.get<std::uint64_t>();
  for (const Figure& figure : kFigures)
    if (left > 0 && is_kept(figure)) std::visit(Get{in, stats}, figure.source), --left;
  if (left > 0)
    throw InputError("snapshot: it has more figures than this version knows; a later version's; run the scene again");
}

}  // namespace impinge
