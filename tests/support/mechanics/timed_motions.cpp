#include "tests/support/mechanics/timed_motions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/geometry/rotation.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/response_worlds.hpp"

namespace impinge::test {
namespace {

void prepare(World& world, const TimedBy& by) {
  world.parameters.simulation.substeps = by.substeps;
  world.parameters.simulation.sleeping = false;
  world.parameters.response.method = "constraint_anticipation";
  set(world, "lcp.tolerance", 1e-12);
  by.settings(world);
}

double time_of(const World& world, int frames) { return frames * world.parameters.simulation.frame_time; }

double mean_square_root(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double e : errors) sum += e * e;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

// ---- rigid bodies

double free_fall(const TimedBy& by, bool of_velocity) {
  World world;
  prepare(world, by);
  BodyDescription body = cube("cube", 0.2, {0, 0, 0});
  body.velocity = {1, 3, 0};
  world.add_body(body);
  world.start();
  run(world, 60);
  const Vec3 g = world.parameters.simulation.gravity;
  if (of_velocity) return (world.record().bodies[0].velocity - (body.velocity + g)).norm();
  return (world.bodies()[0].pose.position - (body.velocity + 0.5 * g)).norm();
}

/// An asymmetric top about its middle axis, nearly: the attitude after a second, against steps a hundredth as long.
double free_rotation_error(const TimedBy& by) {
  const auto turn = [&](int substeps) {
    World world;
    TimedBy own = by;
    own.substeps = substeps;
    prepare(world, own);
    BodyDescription body = dynamic_body("top", Box(Vec3(0.1, 0.2, 0.4)), Vec3::Zero());
    body.angular_velocity = {0.05, 6.0, 0.02};
    world.add_body(body);
    world.start();
    run(world, 60);
    return world.bodies()[0].pose.rotation;
  };
  return rotation_log(turn(by.substeps) * turn(500).transpose()).norm();
}

constexpr double kMu = 0.3;

/// A box that slides over a plane.
void make_sliding(World& world, const TimedBy& by, double speed) {
  prepare(world, by);
  world.parameters.contact.friction = kMu;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  BodyDescription body = dynamic_body("box", Box(Vec3(0.2, 0.05, 0.2)), {0, 0.05, 0});
  body.velocity = {speed, 0, 0};
  world.add_body(body);
  world.start();
}

double sliding(const TimedBy& by, bool of_velocity) {
  World world;
  make_sliding(world, by, 3.0);
  run(world, 30);
  const double t = time_of(world, 30), a = kMu * kGravity;
  if (of_velocity) return std::abs(world.record().bodies[1].velocity.x() - (3.0 - a * t));
  return std::abs(world.bodies()[1].pose.position.x() - (3.0 * t - 0.5 * a * t * t));
}

double stopping(const TimedBy& by) {
  std::vector<double> errors;
  for (int k = 0; k < 8; ++k) {
    const double speed = 1.5 + 0.0213 * k;
    World world;
    make_sliding(world, by, speed);
    run(world, 60);
    errors.push_back(world.bodies()[1].pose.position.x() - speed * speed / (2.0 * kMu * kGravity));
  }
  return mean_square_root(errors);
}

constexpr double kRestitution = 0.8, kRadius = 0.1;

/// A ball that falls and bounces once: its path until shortly before it falls again.
struct Bounce {
  double apex = 0.0;  // m over the place where it touches
  double end = 0.0;   // the same, at the end
  double seconds = 0.0;
};

Bounce bounce(const TimedBy& by, double height) {
  World world;
  prepare(world, by);
  world.parameters.contact.restitution = kRestitution;
  world.parameters.contact.friction = 0.0;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(dynamic_body("ball", Sphere{kRadius}, {0, kRadius + height, 0}));
  world.start();
  std::vector<double> y;
  for (int i = 0; i < 60; ++i) world.step(), y.push_back(world.bodies()[1].pose.position.y() - kRadius);
  // the highest point after the first impact, by the parabola through the three highest frames
  const auto low = std::min_element(y.begin(), y.begin() + 40);
  const auto top = std::max_element(low, y.end());
  const double a = top[-1], b = top[0], c = top[1], bend = a - 2.0 * b + c;
  Bounce result{b - (c - a) * (c - a) / (8.0 * bend), y.back(), time_of(world, 60)};
  return result;
}

double bouncing(const TimedBy& by, bool of_height) {
  std::vector<double> errors;
  for (int k = 0; k < 8; ++k) {
    const double height = 0.8 + 0.0137 * k;
    const Bounce b = bounce(by, height);
    const double speed = kRestitution * std::sqrt(2.0 * kGravity * height);
    const double since = b.seconds - std::sqrt(2.0 * height / kGravity);
    errors.push_back(of_height ? b.apex - kRestitution * kRestitution * height
                               : b.end - (speed * since - 0.5 * kGravity * since * since));
  }
  return mean_square_root(errors);
}

/// A bar of a metre on a point of its end, let go at `angle`.
void make_pendulum(World& world, const TimedBy& by, double angle) {
  prepare(world, by);
  BodyDescription bar =
      dynamic_body("bar", Box(Vec3(0.05, 0.5, 0.05)), {0.5 * std::sin(angle), -0.5 * std::cos(angle), 0});
  bar.rotation = {0, 0, angle * 180.0 / M_PI};
  world.add_body(bar);
  world.add_attachment({"pivot", "bar", "", Vec3::Zero()});
  world.start();
}

double angle_of(const World& world) {
  const Vec3 x = world.bodies()[0].pose.position;
  return std::atan2(x.x(), -x.y());
}

constexpr double kLetGo = 0.6;  // rad

/// Of the bar: moment about its end over mass × arm.
double rate_of_bar() {
  const double moment = (1.0 + 0.01) / 12.0 + 0.25;
  return std::sqrt(kGravity * 0.5 / moment);
}

/// sin(θ/2) = k cd(ωt): let go at rest.
double exact_angle(double let_go, double time) {
  const double k = std::sin(0.5 * let_go);
  // by small steps of a fourth-order rule: nothing of the engine's own elliptic functions
  double angle = let_go, rate = 0.0;
  const double w2 = std::pow(rate_of_bar(), 2);
  const int steps = 20000;
  const double h = time / steps;
  const auto pull = [&](double a) { return -w2 * std::sin(a); };
  for (int i = 0; i < steps; ++i) {
    const double a1 = rate, b1 = pull(angle), a2 = rate + 0.5 * h * b1, b2 = pull(angle + 0.5 * h * a1);
    const double a3 = rate + 0.5 * h * b2, b3 = pull(angle + 0.5 * h * a2), a4 = rate + h * b3,
                 b4 = pull(angle + h * a3);
    angle += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4), rate += h / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
  }
  return k == 0.0 ? 0.0 : angle;
}

double swinging(const TimedBy& by) {
  World world;
  make_pendulum(world, by, kLetGo);
  run(world, 180);
  return std::abs(angle_of(world) - exact_angle(kLetGo, time_of(world, 180)));
}

/// Times at which it passes the lowest point, between frames by the cubic through four of them.
std::vector<double> passages_of(World& world, int frames, std::vector<double>* angles = nullptr) {
  std::vector<double> angle = {angle_of(world)}, passages;
  for (int i = 0; i < frames; ++i) world.step(), angle.push_back(angle_of(world));
  for (std::size_t i = 1; i + 2 < angle.size(); ++i) {
    if (angle[i] * angle[i + 1] > 0.0) continue;
    const auto cubic = [&](double s) {  // s from 0 at i to 1
      return -s * (s - 1) * (s - 2) / 6 * angle[i - 1] + (s + 1) * (s - 1) * (s - 2) / 2 * angle[i] -
             (s + 1) * s * (s - 2) / 2 * angle[i + 1] + (s + 1) * s * (s - 1) / 6 * angle[i + 2];
    };
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (cubic(middle) * cubic(low) > 0.0 ? low : high) = middle;
    }
    passages.push_back((static_cast<double>(i) + low) * world.parameters.simulation.frame_time);
  }
  if (angles != nullptr) *angles = angle;
  return passages;
}

/// Of the mean period of ten seconds, as a share, against the arithmetic-geometric mean.
double period(const TimedBy& by) {
  World world;
  make_pendulum(world, by, kLetGo);
  const std::vector<double> passages = passages_of(world, 600);
  const double measured = 2.0 * (passages.back() - passages.front()) / static_cast<double>(passages.size() - 1);
  double a = 1.0, b = std::cos(0.5 * kLetGo);
  for (int i = 0; i < 10; ++i) std::tie(a, b) = std::pair(0.5 * (a + b), std::sqrt(a * b));
  const double exact = 2.0 * M_PI / (rate_of_bar() * a);
  return std::abs(measured / exact - 1.0);
}

/// A ball on a slope, by gravity that leans: it rolls at once.
double rolling(const TimedBy& by) {
  World world;
  prepare(world, by);
  world.parameters.contact.friction = 0.5;
  const double slope = 0.2;
  world.parameters.simulation.gravity = kGravity * Vec3(std::sin(slope), -std::cos(slope), 0.0);
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(dynamic_body("ball", Sphere{kRadius}, {0, kRadius, 0}));
  world.start();
  run(world, 60);
  const double t = time_of(world, 60);
  return std::abs(world.bodies()[1].pose.position.x() - 0.5 * 5.0 / 7.0 * kGravity * std::sin(slope) * t * t);
}

/// A ball that slides first: friction gives it its spin, and from 2 v / 7 µ g on it rolls at 5/7 of its speed.
double skidding(const TimedBy& by) {
  std::vector<double> errors;
  for (int k = 0; k < 8; ++k) {
    World world;
    prepare(world, by);
    world.parameters.contact.friction = kMu;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    BodyDescription ball = dynamic_body("ball", Sphere{kRadius}, {0, kRadius, 0});
    const double speed = 1.8 + 0.0271 * k;
    ball.velocity = {speed, 0, 0};
    world.add_body(ball);
    world.start();
    run(world, 60);
    const double t = time_of(world, 60), a = kMu * kGravity, rolls = 2.0 * speed / (7.0 * a);
    const double exact = speed * rolls - 0.5 * a * rolls * rolls + 5.0 / 7.0 * speed * (t - rolls);
    errors.push_back(world.bodies()[1].pose.position.x() - exact);
  }
  return mean_square_root(errors);
}

// ---- deformable bodies: against their own mesh with far smaller steps

enum class Soft { fall, swing, hang, rest };

std::vector<Vec3> soft_nodes(const TimedBy& by, Soft what) {
  World world;
  prepare(world, by);
  set(world, "integrator.newmark.tolerance", 1e-11);
  set(world, "integrator.implicit_euler.tolerance", 1e-11);
  set(world, "simulation.linear_solver", "automatic");
  world.parameters.contact.friction = 0.0;
  SoftOptions soft;
  soft.young = 2e4, soft.poisson = 0.3, soft.damping_beta = 0.0;
  const Vec3 size(0.2, 0.4, 0.2);
  if (what == Soft::rest) world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(soft_box("soft", size, {2, 4, 2}, {0, 0, 0}, soft));
  if (what == Soft::hang) world.add_attachment({"pivot", "soft", "", Vec3(0.1, 0.4, 0.1)});
  if (what == Soft::swing) world.parameters.simulation.gravity.setZero();
  DeformableBody& body = deformable(world, what == Soft::rest ? 1 : 0);
  if (what == Soft::swing)
    for (int n = 0; n < body.nodes(); ++n)
      body.velocity[3 * n + 1] = 0.8 * std::sin(M_PI * (body.position[3 * n + 1] / 0.4 - 0.5));
  world.start();
  run(world, 18);
  std::vector<Vec3> nodes;
  for (int n = 0; n < body.nodes(); ++n) nodes.push_back(body.position.segment<3>(3 * n));
  return nodes;
}

double soft_error(const TimedBy& by, Soft what) {
  static std::map<Soft, std::vector<Vec3>> truths;
  std::vector<Vec3>& truth = truths[what];
  if (truth.empty()) {
    TimedBy fine;
    fine.substeps = 512;
    fine.settings = [](World& world) {  // what newmark converges to as well, and much cheaper
      world.parameters.simulation.integrator = "symplectic_euler";
      world.parameters.simulation.velocities = VelocityTime::middle;
    };
    truth = soft_nodes(fine, what);
  }
  const std::vector<Vec3> nodes = soft_nodes(by, what);
  std::vector<double> errors;
  for (std::size_t i = 0; i < nodes.size(); ++i) errors.push_back((nodes[i] - truth[i]).norm());
  return mean_square_root(errors);
}

}  // namespace

const std::vector<TimedMotion>& timed_motions() {
  static const std::vector<TimedMotion> all = {
      {"free fall, place", "m", false, [](const TimedBy& by) { return free_fall(by, false); }},
      {"free fall, speed", "m/s", false, [](const TimedBy& by) { return free_fall(by, true); }},
      {"free rotation", "rad", false, free_rotation_error},
      {"sliding, place", "m", false, [](const TimedBy& by) { return sliding(by, false); }},
      {"sliding, speed", "m/s", false, [](const TimedBy& by) { return sliding(by, true); }},
      {"sliding to a stop", "m", false, stopping},
      {"bounce, height", "m", false, [](const TimedBy& by) { return bouncing(by, true); }},
      {"bounce, place", "m", false, [](const TimedBy& by) { return bouncing(by, false); }},
      {"pendulum, angle after 3 s", "rad", false, swinging},
      {"pendulum, period", "1", false, period},
      {"pendulum, swing after 60 s", "1", false,
       [](const TimedBy& by) { return std::abs(swing_left(by, 60.0) - 1.0); }},
      {"rolling down a slope", "m", false, rolling},
      {"skidding into rolling", "m", false, skidding},
      {"soft: free fall", "m", true, [](const TimedBy& by) { return soft_error(by, Soft::fall); }},
      {"soft: free oscillation", "m", true, [](const TimedBy& by) { return soft_error(by, Soft::swing); }},
      {"soft: hanging on an attachment", "m", true, [](const TimedBy& by) { return soft_error(by, Soft::hang); }},
      {"soft: settling on a floor", "m", true, [](const TimedBy& by) { return soft_error(by, Soft::rest); }},
  };
  return all;
}

const TimedMotion& timed_motion(const std::string& name) {
  for (const TimedMotion& motion : timed_motions())
    if (motion.name == name) return motion;
  throw InternalError("no motion " + name);
}

double observed_order(const std::vector<double>& errors) {
  double sum = 0.0, square = 0.0;
  const double middle = 0.5 * static_cast<double>(errors.size() - 1);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double x = static_cast<double>(i) - middle;
    sum -= x * std::log2(errors[i]), square += x * x;
  }
  return sum / square;
}

double swing_left(const TimedBy& by, double seconds) {
  World world;
  make_pendulum(world, by, kLetGo);
  std::vector<double> angles;
  passages_of(world, static_cast<int>(std::lround(60.0 * seconds)), &angles);
  double most = 0.0;  // of the last two periods: between frames by the parabola through three
  for (std::size_t i = angles.size() - 200; i + 1 < angles.size(); ++i) {
    const double a = angles[i - 1], b = angles[i], c = angles[i + 1], bend = a - 2.0 * b + c;
    if ((b - a) * (c - b) > 0.0 || bend == 0.0) continue;
    most = std::max(most, std::abs(b - (c - a) * (c - a) / (8.0 * bend)));
  }
  return most / kLetGo;
}

}  // namespace impinge::test
