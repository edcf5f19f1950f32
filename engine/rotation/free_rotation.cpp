#include "engine/rotation/free_rotation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/rotation/elliptic_functions.hpp"

namespace impinge {
namespace {

constexpr double kMostTurn = 1e9;   // radians in a step: rounding of such an angle alone turns a body by 1e-7
constexpr double kCommutes = 1e-8;  // radians: the square of such a turn is below rounding, so its axis may be held
constexpr double kRests = 1e-100;   // of a unit vector: what is nearer to a resting axis than that stays there
constexpr double kRounding = 1e-16;

/// The momentum as the body sees it, a unit vector: it runs along a closed curve round x, which is the axis of least
/// inertia or that of largest; y is the middle axis; x > 0. With L the momentum's length
///
///     x' = -s L d_yz y z,    y' = s L d_xz z x,    z' = -s L d_xy x y
///
/// so that x, y, z are dn, sn, cn of u = u0 + s rate L time, times their largest values.
struct Curve {
  Mat3 axes;                ///< columns: x, y, z in the body's axes, right-handed
  double x, y, z;           ///< of the momentum, |.| = 1
  double d_xy, d_yz, d_xz;  ///< |1/I_x - 1/I_y| and so on, 1/(kg·m²); d_xz = d_xy + d_yz
  double side;              ///< s: 1 where x has the least inertia, -1 where it has the largest
  double from_x, from_z;    ///< |2E/L² - 1/I|: how far the energy is from that of a turn about x, and about z
  double from_y;            ///< the same about y, where curves of both kinds meet: the separatrix

  double rate() const { return std::sqrt(d_xy * from_z); }
  /// k'² = 1 - k²
  double complement() const { return std::min(1.0, d_xz * from_y / (d_xy * from_z)); }
  /// Whether the momentum stays where it is: the turn is about a principal axis.
  bool is_at_rest() const { return x < kRests || std::max(std::abs(y), std::abs(z)) < kRests || !(from_x > 0.0); }
};

Curve curve_of(const PrincipalInertia& inertia, const Vec3& unit) {
  const Vec3 inverse = inertia.moments.cwiseInverse(), m = inertia.axes.transpose() * unit;
  const double d01 = inverse[0] - inverse[1], d12 = inverse[1] - inverse[2];
  const double above = d01 * m[0] * m[0] - d12 * m[2] * m[2];
  Curve c;
  c.d_xz = inverse[0] - inverse[2];
  if (above > 0.0) {
    c.axes = inertia.axes;
    c.x = m[0], c.y = m[1], c.z = m[2];
    c.d_xy = d01, c.d_yz = d12, c.side = 1.0;
  } else {
    c.axes << inertia.axes.col(2), -inertia.axes.col(1), inertia.axes.col(0);
    c.x = m[2], c.y = -m[1], c.z = m[0];
    c.d_xy = d12, c.d_yz = d01, c.side = -1.0;
  }
  if (c.x < 0.0) {
    c.x = -c.x, c.z = -c.z;
    c.axes.col(0) *= -1.0, c.axes.col(2) *= -1.0;
  }
  c.from_x = c.d_xy * c.y * c.y + c.d_xz * c.z * c.z;
  c.from_z = c.d_xz * c.x * c.x + c.d_yz * c.y * c.y;
  // a difference, so known to rounding only, and taken as no smaller: no digit tells what is nearer to the separatrix
  c.from_y = std::max(std::abs(above), kRounding * c.d_xy * c.x * c.x);
  return c;
}

/// How far along its curve the momentum goes: sn, cn and dn of rate L time, less `halves` of their half periods.
struct Stretch {
  double halves, cn, dn;
  double t;  ///< sn/rate

  bool is_turned() const { return std::fmod(halves, 2.0) != 0.0; }
};

Stretch stretch(const Curve& c, double w) {
  const JacobiFunctions functions(c.complement());
  const double u = w * c.rate(), half_period = 2.0 * functions.quarter_period();
  const double halves = std::nearbyint(u / half_period);
  const JacobiFunctions::Values at = functions.at(u - halves * half_period);
  return {halves, at.cn, at.dn, at.sn / c.rate()};
}

/// Where the momentum comes to: the addition theorems of dn, sn and cn with what x, y and z are of them put in. `t` and
/// `cn`: of the stretch, with the signs of its half periods and of s.
Vec3 moved(const Curve& c, double t, double cn, double dn) {
  return Vec3(c.x * dn - c.d_yz * t * cn * c.y * c.z, c.y * cn * dn + c.d_xz * t * c.z * c.x,
              c.z * cn - c.d_xy * t * dn * c.x * c.y) /
         (dn * dn + c.d_yz * c.d_xz * t * t * c.z * c.z);
}

/// The momentum stays in space, so the attitude is known up to an angle about it, that of the node e_x × m. By this
///
///     d_yz y² / (y² + z²) where s = 1 (beyond 1/I_z),    d_yz z² / (y² + z²) where s = -1 (beyond 1/I_y)
///
/// times L it grows a second, nothing of which cancels; an elliptic integral of the third kind, here from y = 0, or
/// z = 0, on.
double third_kind(const Curve& c, const Stretch& by) {
  const double cube = by.t * by.t * by.t / 3.0, cn2 = by.cn * by.cn, dn2 = by.dn * by.dn;
  const double whole = 2.0 * by.halves * c.d_yz / (3.0 * c.rate()), complement = c.complement();
  if (c.side > 0.0) {
    const double rest =
        c.d_yz * c.d_xz * c.from_z * cube * carlson_rj(cn2, dn2, 1.0, 1.0 + c.d_yz * c.from_z * by.t * by.t);
    if (by.halves == 0.0) return rest;
    return rest + whole * c.d_xz / c.d_xy * carlson_rj(0.0, complement, 1.0, c.d_xz / c.d_xy);
  }
  const double rest =
      c.d_yz * c.d_xy * c.from_y * cube * carlson_rj(cn2, dn2, 1.0, (c.d_xy * dn2 + c.d_yz * cn2) / c.d_xz);
  if (by.halves == 0.0) return rest;
  return rest + whole * c.from_y / c.from_z * carlson_rj(0.0, complement, 1.0, c.d_xy * complement / c.d_xz);
}

/// The addition theorem of that integral, which moves its ends to c and `to`. It reads the same from either end, and is
/// taken from the one where less cancels.
double third_kind_from_here(const Curve& c, const Vec3& to, double t) {
  const double k = c.d_yz * t, off_from = c.y * c.y + c.z * c.z, off_to = to.y() * to.y() + to.z() * to.z();
  if (c.side > 0.0) {
    const double from = k * c.z * c.x * to.y(), ahead = -k * to.z() * to.x() * c.y;
    const bool is_from = off_from + std::abs(from) < off_to + std::abs(ahead);
    return std::atan2(k * c.y * to.y(), is_from ? off_from + from : off_to + ahead);
  }
  const double from = k * to.z() * c.y, ahead = -k * c.z * to.y();
  const bool is_from = to.x() * (to.x() * off_from + std::abs(from)) < c.x * (c.x * off_to + std::abs(ahead));
  return -std::atan2(k * c.z * to.z() * (is_from ? c.x : to.x()),
                     is_from ? to.x() * off_from + from : c.x * off_to + ahead);
}

/// Columns: the node, a unit vector along e_x × m; m × node; m.
Mat3 node_frame(const Vec3& m) {
  const double off_axis = std::hypot(m.y(), m.z()), length = std::hypot(m.x(), off_axis);
  const double c = m.x() / length, s = off_axis / length, cy = m.y() / off_axis, cz = m.z() / off_axis;
  Mat3 frame;
  frame << 0.0, s, c, -cz, -c * cy, s * cy, cy, -c * cz, s * cz;
  return frame;
}

void check_turn(double radians) {
  if (radians <= kMostTurn) return;
  throw DivergenceError(
      fmt::format("it turns by {:.3g} rad in a sub-step, and at most {:g} can be followed", radians, kMostTurn));
}

}  // namespace

Mat3 free_rotation(const PrincipalInertia& given, const Vec3& given_momentum, double time) {
  // in units of a power of two near the largest moment, which changes no digit: squares neither overflow nor vanish
  const double unit = std::exp2(-std::ilogb(given.moments[2]));
  const PrincipalInertia inertia{unit * given.moments, given.axes};
  const Vec3 momentum = unit * given_momentum;
  const double length = momentum.stableNorm(), w = length * time;
  const auto about_held_axis = [&] {
    const Vec3 along = inertia.axes.transpose() * momentum;
    const Vec3 turn = time * (inertia.axes * along.cwiseQuotient(inertia.moments));
    check_turn(turn.stableNorm());
    return rotation_exp(turn);
  };
  const bool is_spherical = inertia.moments[0] == inertia.moments[2];
  if (is_spherical || w <= kCommutes * inertia.moments[0]) return about_held_axis();
  const Curve from = curve_of(inertia, momentum / length);
  if (from.is_at_rest()) return about_held_axis();

  const double base = w / inertia.moments[from.side > 0.0 ? 2 : 1];
  check_turn(w * from.rate());
  check_turn(base);
  const Stretch by = stretch(from, w);
  const double sign = by.is_turned() ? -1.0 : 1.0, t = sign * from.side * by.t;
  const Vec3 to = moved(from, t, sign * by.cn, by.dn);
  const double angle = base + third_kind(from, by) + third_kind_from_here(from, to, t);
  const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  return (from.axes * node_frame(Vec3(from.x, from.y, from.z))) * turn * (from.axes * node_frame(to)).transpose();
}

}  // namespace impinge
