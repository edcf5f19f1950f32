#include "engine/step/turns/landing.hpp"

#include <algorithm>

#include "engine/step/turns/end_rows.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostBodies = 8;  // what many do to one another is no matter of who carries for half a sub-step
// of the activation distance: how far, either way, what carried before may be to stand
constexpr double kStanding = 0.02;
// of a contact's scale: what it stands on closed no faster before; and what comes down faster is a blow too
constexpr double kBlow = 0.1, kFast = 0.6;
constexpr double kOneFace = 1.0 - 1e-4;  // cosine; round a bend it is a blow
// of the sub-step: impulses of its start stand for the half before and the half after, between velocities of two middles
constexpr double kHalf = 0.5;

/// By row: 1 where it is open at the start.
std::vector<char> open_rows(const GroupSystem& system, std::span<const Vec3> carried_before,
                            const ContactSettings& settings) {
  std::vector<char> open;
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    const ContactRows& row = system.contacts[i];
    const double near = carried_before[i].x() > 0.0 ? kStanding : kTurningTolerance;
    open.push_back(row.kind == RowKind::contact && row.gap > near * settings.activation_distance.at(row.scale.length));
  }
  return open;
}

/// Of the same two, or of one and what can't respond, which look at each other the same way.
bool on_same_face(const ContactRows& row, const ContactRows& other) {
  return row.kind == RowKind::contact && row.a.rigid == other.a.rigid && row.b.rigid == other.b.rigid &&
         row.directions.row(0).dot(other.directions.row(0)) > kOneFace;
}

/// A closed row that is struck, or deep: what falls or comes out of an overlap stands on nothing.
bool is_unsettled(const ContactRows& row, const ContactSettings& settings) {
  return row.gap < -kStanding * settings.activation_distance.at(row.scale.length) ||
         row.velocity_before < -kBlow * row.scale.speed;
}

/// Whether one of them carries what stands on the same face.
bool lands(const GroupSystem& solved, const std::vector<char>& open, const ContactSettings& settings) {
  bool is_landing = false;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const ContactRows& row = solved.contacts[i];
    if (row.kind != RowKind::contact) continue;
    if (open[i] == 0 && is_unsettled(row, settings)) return false;
    if (open[i] == 0 || !(solved.lambda[i].x() > 0.0)) continue;
    for (std::size_t k = 0; k < open.size() && !is_landing; ++k)
      is_landing = open[k] == 0 && on_same_face(solved.contacts[k], row);
  }
  return is_landing;
}

/// After which share of the sub-step the first of them closes; none: that is later, or one is a blow.
std::optional<double> share_to_landing(GroupSystem standing, const GroupSystem& solved, const std::vector<char>& open,
                                       double time_step) {
  standing.contacts = solved.contacts;
  std::optional<double> first;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (open[i] == 0) continue;
    const double way = -time_step * standing.displacement_velocity(i).x();
    if (way > kFast * time_step * solved.contacts[i].scale.speed) return std::nullopt;
    if (way > solved.contacts[i].gap) first = std::min(first.value_or(1.0), solved.contacts[i].gap / way);
  }
  return first;
}

}  // namespace

void Landing::begin(GroupSystem& system) const {
  for (std::size_t b = 0; b < system.rigid.size(); ++b) {
    system.rigid[b].velocity += delta_velocity[b];
    system.rigid[b].angular_velocity += delta_angular_velocity[b];
  }
  for (std::size_t i = 0; i < lambda.size(); ++i)
    if (!lambda[i].isZero(0.0)) system.lambda[i] *= 1.0 - share;
  system.clear_delta();
}

void Landing::close(GroupSystem& system) const {
  for (std::size_t b = 0; b < system.rigid.size(); ++b) {
    system.rigid[b].velocity -= delta_velocity[b];
    system.rigid[b].angular_velocity -= delta_angular_velocity[b];
    system.delta_velocity[b] += delta_velocity[b];
    system.delta_angular_velocity[b] += delta_angular_velocity[b];
  }
  for (std::size_t i = 0; i < lambda.size(); ++i) system.lambda[i] += lambda[i];
}

std::optional<Landing> find_landing(const GroupSystem& solved, std::span<const Vec3> carried_before,
                                    const ContactSettings& settings, double time_step,
                                    const std::function<bool(GroupSystem&)>& solve_standing) {
  if (!solved.deformable.empty() || solved.rigid.size() > kMostBodies) return std::nullopt;
  const auto is_late = [](const ContactRows& row) { return row.impact > 0.0; };
  if (std::any_of(solved.contacts.begin(), solved.contacts.end(), is_late)) return std::nullopt;
  const std::vector<char> open = open_rows(solved, carried_before, settings);
  if (!lands(solved, open, settings)) return std::nullopt;
  GroupSystem standing = solved.without(open);
  if (!solve_standing(standing)) return std::nullopt;
  const std::optional<double> landed = share_to_landing(standing, solved, open, time_step);
  if (!landed) return std::nullopt;
  const double share = std::min(1.0, *landed + kHalf);
  Landing landing{share, {}, standing.delta_velocity, standing.delta_angular_velocity};
  for (Vec3& v : landing.delta_velocity) v *= share;
  for (Vec3& v : landing.delta_angular_velocity) v *= share;
  auto carried = standing.lambda.begin();
  for (const char is_open : open)
    landing.lambda.push_back(is_open != 0 ? Vec3(Vec3::Zero()) : Vec3(share * *carried++));
  return landing;
}

}  // namespace impinge
