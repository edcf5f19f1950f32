#include "engine/response/packed_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "engine/contact/mobility.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/response/passive_impulses.hpp"

namespace impinge {
namespace {

// a task should last longer than it takes to wake a thread: some 20 µs
constexpr int kPairsPerTask = 192;
constexpr int kRowsPerTask = 64;
constexpr int kMostStrikes = 200;  // sweeps over a pair's contacts that bounce
// turns below the root of this add to gaps in the second order, which is rounding to what they are known to
constexpr double kNoTurn = 1e-10;

/// How far an arm r that turned by t has come along n in the second order, n·(t × (t × r))/2, without what `skin` of it along
/// n would do: that of a ball or rod is as thick wherever it is turned.
template <class T>
inline double bend(const T& t, const T& r, const T& n, double skin) {
  return 0.5 * (dot(t, r) * dot(t, n) - dot(t, t) * dot(r, n) + skin * (dot(t, t) - dot(t, n) * dot(t, n)));
}

double largest_across(const Mat3& w) {
  const double mean = 0.5 * (w(1, 1) + w(2, 2)), half = 0.5 * (w(1, 1) - w(2, 2));
  return mean + std::sqrt(half * half + w(1, 2) * w(1, 2));
}

/// W of one contact of rigid bodies, 1/kg.
Mat3 mobility(const GroupSystem& group, const ContactRows& row) {
  Mat3 w = Mat3::Zero();
  for (const ContactSide* side : {&row.a, &row.b})
    if (side->rigid >= 0) w += mobility(group.rigid[side->rigid], row.directions, side->arm);
  return w;
}

}  // namespace

SoftLaw soft_law(double hertz, double ratio, double h) {
  const double omega = 2.0 * M_PI * hertz;
  const double a1 = 2.0 * ratio + h * omega, a2 = h * omega * a1, a3 = 1.0 / (1.0 + a2);
  return {omega / a1, a2 * a3, a3};
}

PackedContacts::PackedContacts(const GroupSystem& group, const Vec3& velocity_change, double share,
                               const Threshold& max_push_out, const Threshold& restitution_threshold) {
  bodies_.resize(group.rigid.size());
  start_velocity_.resize(group.rigid.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const RigidBlock& block = group.rigid[b];
    Body& body = bodies_[b];
    start_velocity_[b] = block.velocity - velocity_change;
    body.velocity = triple(start_velocity_[b]);
    body.angular_velocity = triple(block.angular_velocity);
    body.inverse_mass = block.inverse_mass, body.rounding = block.rounding;
    const Mat3& m = block.inverse_inertia;
    const double upper[6] = {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
    std::copy(upper, upper + 6, body.inverse_inertia);
  }

  std::vector<Pair> pairs;  // in the rows' order, `first` in the group
  std::vector<BodyPlaces> places;
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const ContactRows& row = group.contacts[i];
    if (row.kind != RowKind::contact) continue;
    const BodyPlaces now{row.a.rigid, row.b.rigid};
    const bool follows =
        !pairs.empty() && places.back() == now && pairs.back().first + pairs.back().count == static_cast<int>(i);
    if (!follows) pairs.push_back({now.first, now.second, static_cast<int>(i), 0, false}), places.push_back(now);
    ++pairs.back().count;
    if (!row.surface.isZero(0.0)) pairs.back().is_driven = true;
  }
  add_joints(group, share);
  PairColours colours = colour_pairs(places, static_cast<int>(bodies_.size()));
  colours_ = std::move(colours.begin);
  last_is_rest_ = colours.last_is_rest;
  pairs_.reserve(pairs.size());
  rows_.reserve(group.contacts.size());
  for (const int k : colours.order) {
    pairs_.push_back(pairs[k]);
    pairs_.back().first = static_cast<int>(rows_.size());
    for (int i = 0; i < pairs[k].count; ++i) rows_.push_back(pairs[k].first + i);
  }
  contacts_.resize(rows_.size());
  if (std::any_of(pairs_.begin(), pairs_.end(), [](const Pair& p) { return p.is_driven; }))
    surface_.resize(rows_.size());
  sum_n_.assign(rows_.size(), 0.0);
  sum_t_.assign(rows_.size(), Triple());
  const std::size_t tasks = (rows_.size() + kRowsPerTask - 1) / kRowsPerTask;
  parallel_for(tasks, 1, [&](std::size_t task) {
    const std::size_t end = std::min(rows_.size(), (task + 1) * kRowsPerTask);
    for (std::size_t i = task * kRowsPerTask; i < end; ++i) fill(group, i, share, max_push_out, restitution_threshold);
  });
}

void PackedContacts::fill(const GroupSystem& group, std::size_t place, double share, const Threshold& max_push_out,
                          const Threshold& restitution_threshold) {
  const ContactRows& row = group.contacts[rows_[place]];
  Contact& c = contacts_[place];
  const Mat3& d = row.directions;
  const Mat3 w = mobility(group, row);
  const double across = largest_across(w);
  c.normal = triple(d.row(0));
  c.arm_a = triple(row.a.arm), c.arm_b = triple(row.b.arm);
  c.moment_a = cross(c.arm_a, c.normal), c.moment_b = cross(c.arm_b, c.normal);
  c.spin_a = row.a.rigid < 0 ? Triple() : times(bodies_[row.a.rigid].inverse_inertia, c.moment_a);
  c.spin_b = row.b.rigid < 0 ? Triple() : times(bodies_[row.b.rigid].inverse_inertia, c.moment_b);
  c.inverse_n = w(0, 0) > 0.0 ? 1.0 / w(0, 0) : 0.0;
  c.inverse_t = across > 0.0 ? 1.0 / across : 0.0;
  c.gap = row.gap;
  c.friction = row.friction;
  c.max_push_out = max_push_out.at(row.scale.speed);
  c.bounces_from = row.restitution > 0.0 ? restitution_threshold.at(row.scale.speed) : INFINITY;
  const Vec3 start = share * group.lambda[rows_[place]];
  c.impulse = start.x();
  c.tangent = triple(start.y() * d.row(1) + start.z() * d.row(2));
  if (!surface_.empty()) surface_[place] = triple(d.transpose() * row.surface);
}

int PackedContacts::collide(const GroupSystem& group, const Vec3& velocity_change, double time_step, int most) {
  double fastest = 0.0;
  std::vector<const Pair*> bounce;
  for (const Pair& pair : pairs_)
    for (int i = pair.first; i < pair.first + pair.count; ++i) {
      const ContactRows& row = group.contacts[rows_[i]];
      if (row.restitution == 0.0 || contacts_[i].inverse_n == 0.0) continue;
      fastest = std::max(fastest, -row.velocity_before);
      if (bounce.empty() || bounce.back() != &pair) bounce.push_back(&pair);
    }
  if (bounce.empty()) return 0;
  // the order of the scene, not of the colours: a shot runs through a row of balls
  std::sort(bounce.begin(), bounce.end(),
            [&](const Pair* l, const Pair* r) { return rows_[l->first] < rows_[r->first]; });
  const double slow = 1e-9 * fastest;  // what is left of rounding
  const Triple change = triple(velocity_change);
  int rounds = 0;
  for (bool more = true; more && rounds < most; ++rounds) {
    check_interrupt();
    more = false;
    for (const Pair* pair : bounce) {
      const Sides sides(bodies_, pair->a, pair->b);
      const double forced = (pair->a >= 0 ? 1 : 0) - (pair->b >= 0 ? 1 : 0);
      std::vector<Strike> strikes;
      for (int i = pair->first; i < pair->first + pair->count; ++i) {
        const Contact& c = contacts_[i];
        const double restitution = group.contacts[rows_[i]].restitution;
        if (restitution == 0.0 || c.inverse_n == 0.0) continue;
        const double closing = dot(c.normal, slip(*pair, i, sides));
        // what closes by forces alone rests, and doesn't bounce
        const double moved = time_step * (closing + forced * dot(c.normal, change));
        if (!(closing < -std::max(slow, c.bounces_from)) || c.gap + moved >= 0.0) continue;
        strikes.push_back({i, -restitution * closing, 0.0});
      }
      if (strikes.empty()) continue;
      strike(*pair, strikes, slow);
      more = true;
    }
  }
  return rounds;
}

/// The contacts of a pair that close get together what returns -e of each one's approach: one after the other those of a
/// face would turn it away from what the last ones had to return. With friction that may win energy: less of all of it then.
void PackedContacts::strike(const Pair& pair, std::vector<Strike>& strikes, double slow) {
  Sides sides(bodies_, pair.a, pair.b);
  for (Strike& at : strikes) at.before = slip(pair, at.contact, sides);
  for (int sweep = 0; sweep < kMostStrikes; ++sweep) {
    double largest = 0.0;
    for (Strike& at : strikes) {
      Contact& c = contacts_[at.contact];
      const double missing = at.wanted - dot(c.normal, slip(pair, at.contact, sides));
      const double more = std::max(-at.given, missing * c.inverse_n);
      at.given += more;
      Triple impulse;
      add(impulse, more, c.normal);
      sides.push(c.arm_a, c.arm_b, impulse);
      add(at.impulse, 1.0, impulse);
      sum_n_[at.contact] += more;
      largest = std::max(largest, std::abs(more) / c.inverse_n);
      c.impulse = 0.0, c.tangent = Triple();  // that of a resting state says nothing about an impact
      if (c.friction == 0.0) continue;
      Triple u = slip(pair, at.contact, sides);
      add(u, -dot(c.normal, u), c.normal);
      Triple tangent = sum_t_[at.contact];
      add(tangent, -c.inverse_t, u);
      const double limit = c.friction * sum_n_[at.contact], size = std::sqrt(dot(tangent, tangent));
      Triple clamped;
      add(clamped, size > limit ? limit / size : 1.0, tangent);
      const Triple across = difference(clamped, sum_t_[at.contact]);
      sides.push(c.arm_a, c.arm_b, across);
      add(at.impulse, 1.0, across);
      sum_t_[at.contact] = clamped;
      largest = std::max(largest, std::sqrt(dot(across, across)) / c.inverse_t);
    }
    if (largest <= slow || strikes.size() == 1) break;
  }
  double came = 0.0, left = 0.0;
  for (const Strike& at : strikes)
    came += dot(at.impulse, at.before), left += dot(at.impulse, slip(pair, at.contact, sides));
  const double less = passive_share(came, left) - 1.0;
  if (less == 0.0) return;
  for (const Strike& at : strikes) {
    const Contact& c = contacts_[at.contact];
    Triple back, across = at.impulse;
    add(back, less, at.impulse), add(across, -at.given, c.normal);
    sides.push(c.arm_a, c.arm_b, back);
    sum_n_[at.contact] += less * at.given;
    add(sum_t_[at.contact], less, across);
  }
}

PackedContacts::Triple PackedContacts::slip(const Pair& pair, int contact, const Sides& sides) const {
  const Triple u = sides.velocity(contacts_[contact].arm_a, contacts_[contact].arm_b);
  return pair.is_driven ? sum(u, surface_[contact]) : u;
}

void PackedContacts::accelerate(const Vec3& change) {
  const Triple by = triple(change);
  for (Body& body : bodies_) add(body.velocity, 1.0, by);
}

template <class Work>
void PackedContacts::for_each_pair(const Work& work) {
  for (std::size_t colour = 0; colour + 1 < colours_.size(); ++colour) {
    const int begin = colours_[colour], end = colours_[colour + 1];
    const bool is_rest = last_is_rest_ && colour + 2 == colours_.size();
    if (is_rest || end - begin < 2 * kPairsPerTask) {
      for (int p = begin; p < end; ++p) work(pairs_[p]);
      continue;
    }
    const int tasks = (end - begin) / kPairsPerTask;
    parallel_for(static_cast<std::size_t>(tasks), 1, [&](std::size_t task) {
      const int first = begin + static_cast<int>(task) * kPairsPerTask,
                last = static_cast<int>(task) + 1 == tasks ? end : first + kPairsPerTask;
      for (int p = first; p < last; ++p) work(pairs_[p]);
    });
  }
}

void PackedContacts::warm_start() {
  for (const Joint& joint : joints_) give(joint, joint.impulse, bodies_);
  for_each_pair([&](const Pair& pair) { give(pair); });
}

void PackedContacts::give(const Pair& pair) {
  Sides sides(bodies_, pair.a, pair.b);
  for (int i = pair.first; i < pair.first + pair.count; ++i) {
    const Contact& c = contacts_[i];
    if (c.impulse == 0.0) continue;
    Triple impulse = c.tangent;
    add(impulse, c.impulse, c.normal);
    sides.push(c.arm_a, c.arm_b, impulse);
  }
}

void PackedContacts::sweep(const SweepLaw& law) {
  check_interrupt();
  if (!all_joints_) relax_joints();
  for_each_pair([&](const Pair& pair) { relax(pair, law); });
  if (all_joints_) relax_joints();
}

inline double PackedContacts::gap_of(const Pair& pair, int contact, const Sides& sides, double elapsed) const {
  const Contact& c = contacts_[contact];
  const Body &a = sides.a, &b = sides.b;
  double gap = c.gap + dot(c.normal, difference(a.shift, b.shift)) + dot(c.moment_a, a.turn) - dot(c.moment_b, b.turn);
  if (dot(a.turn, a.turn) > kNoTurn) gap += bend(a.turn, c.arm_a, c.normal, -a.rounding);
  if (dot(b.turn, b.turn) > kNoTurn) gap -= bend(b.turn, c.arm_b, c.normal, b.rounding);
  if (pair.is_driven) gap += elapsed * dot(c.normal, surface_[contact]);
  return gap;
}

void PackedContacts::relax(const Pair& pair, const SweepLaw& law) {
  Sides sides(bodies_, pair.a, pair.b);
  Body &a = sides.a, &b = sides.b;
  const SoftLaw& spring = pair.a < 0 || pair.b < 0 ? law.fixed : law.between;
  const double inverse_step = 1.0 / law.time_step;
  for (int i = pair.first; i < pair.first + pair.count; ++i) {
    Contact& c = contacts_[i];
    double un = dot(c.normal, difference(a.velocity, b.velocity)) + dot(c.moment_a, a.angular_velocity) -
                dot(c.moment_b, b.angular_velocity);
    if (pair.is_driven) un += dot(c.normal, surface_[i]);
    const double gap = gap_of(pair, i, sides, law.elapsed), before = c.impulse;
    // what has come up to a surface bounces in the next sub-step, with the speed that it comes with
    if (!law.recovers && before == 0.0 && un < -c.bounces_from) continue;
    double next = before;
    if (gap > 0.0)
      next -= c.inverse_n * (un + gap * inverse_step);
    else if (law.recovers)
      next -= c.inverse_n * spring.mass_scale * (un + std::max(spring.bias_rate * gap, -c.max_push_out)) +
              spring.impulse_scale * before;
    else
      next -= c.inverse_n * un;
    next = std::max(0.0, next);
    if (before == 0.0 && next == 0.0) continue;
    const double change = next - before;
    c.impulse = next;
    add(a.velocity, a.inverse_mass * change, c.normal);
    add(a.angular_velocity, change, c.spin_a);
    add(b.velocity, -b.inverse_mass * change, c.normal);
    add(b.angular_velocity, -change, c.spin_b);
    if (c.friction == 0.0) continue;
    Triple u = sides.velocity(c.arm_a, c.arm_b);
    if (pair.is_driven) u = sum(u, surface_[i]);
    add(u, -dot(c.normal, u), c.normal);
    Triple tangent = c.tangent;
    add(tangent, -c.inverse_t, u);
    const double limit = c.friction * next, size = dot(tangent, tangent);
    if (size > limit * limit) {
      const double scale = limit / std::sqrt(size);
      tangent.x *= scale, tangent.y *= scale, tangent.z *= scale;
    }
    sides.push(c.arm_a, c.arm_b, difference(tangent, c.tangent));
    c.tangent = tangent;
  }
}

void PackedContacts::move(double time_step) {
  for (Body& body : bodies_) {
    add(body.shift, time_step, body.velocity);
    add(body.turn, time_step, body.angular_velocity);
  }
}

void PackedContacts::close_step() {
  ++steps_;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    sum_n_[i] += contacts_[i].impulse;
    add(sum_t_[i], 1.0, contacts_[i].tangent);
  }
  for (Joint& joint : joints_) joint.sum += joint.impulse;
}

std::vector<char> PackedContacts::only_pinned() const {
  std::vector<char> bodies(bodies_.size(), 0);
  const auto mark = [&](int a, int b, char value) {
    for (const int body : {a, b})
      if (body >= 0) bodies[static_cast<std::size_t>(body)] = value;
  };
  for (const Joint& joint : joints_)
    if (joint.holds_points) mark(joint.a, joint.b, 1);
  for (const Pair& pair : pairs_) mark(pair.a, pair.b, 0);
  return bodies;
}

void PackedContacts::write(GroupSystem& group, const Vec3& velocity_change, double moved_for) const {
  const auto along_rows = [&](std::size_t i, double normal, const Triple& tangent) {
    const Mat3& d = group.contacts[rows_[i]].directions;
    return Vec3(normal, d.row(1).dot(vector(tangent)), d.row(2).dot(vector(tangent)));
  };
  for (std::size_t i = 0; i < contacts_.size(); ++i) group.lambda[rows_[i]] = along_rows(i, sum_n_[i], sum_t_[i]);
  const auto to_rows = [&](const Joint& joint, const VecX& impulse, std::vector<Vec3>& of_rows) {
    for (const JointRow& row : joint.rows) of_rows[row.row].setZero();
    for (std::size_t r = 0; r < joint.rows.size(); ++r)
      of_rows[joint.rows[r].row][joint.rows[r].k] = impulse[static_cast<Eigen::Index>(r)];
  };
  for (const Joint& joint : joints_) to_rows(joint, joint.sum, group.lambda);
  if (moved_for > 0.0) {
    group.next_start.resize(group.lambda.size());
    for (std::size_t i = 0; i < contacts_.size(); ++i)
      group.next_start[rows_[i]] = steps_ * along_rows(i, contacts_[i].impulse, contacts_[i].tangent);
    for (const Joint& joint : joints_) to_rows(joint, steps_ * joint.impulse, group.next_start);
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    group.delta_velocity[b] = vector(body.velocity) - (start_velocity_[b] + velocity_change);
    group.delta_angular_velocity[b] = vector(body.angular_velocity) - group.rigid[b].angular_velocity;
  }
  if (moved_for > 0.0 && !is_only_joined(group)) write_positions(group, moved_for);
}

void PackedContacts::write_positions(GroupSystem& group, double moved_for) const {
  group.position_velocity.resize(bodies_.size());
  group.position_angular_velocity.resize(bodies_.size());
  const std::vector<char> is_only_pinned = only_pinned();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    if (is_only_pinned[b] != 0) {
      group.position_velocity[b] = group.position_angular_velocity[b] = Vec3::Zero();
      continue;
    }
    group.position_velocity[b] = vector(body.shift) / moved_for - vector(body.velocity);
    group.position_angular_velocity[b] = vector(body.turn) / moved_for - vector(body.angular_velocity);
  }
  if (all_joints_ && std::find(is_only_pinned.begin(), is_only_pinned.end(), 1) != is_only_pinned.end())
    keep_joined(group);
}

}  // namespace impinge
