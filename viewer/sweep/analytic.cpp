// Motions with a formula: what a body that only translates does in free flight, sliding on a plane, and bouncing off
// it.
#include <fmt/format.h>

#include <cmath>

#include "engine/bodies/rigid_body.hpp"
#include "engine/bodies/scale.hpp"
#include "engine/core/error.hpp"
#include "engine/shapes/primitives.hpp"
#include "viewer/sweep/reference.hpp"

namespace impinge {

namespace {

[[noreturn]] void unfit(const std::string& name, const std::string& found, const std::string& wanted) {
  throw InputError(
      fmt::format("{}; case:{} wants {}; change the scene, or choose another reference", found, name, wanted));
}

struct OnPlane {
  const RigidBody* body = nullptr;
  Vec3 normal = Vec3::UnitY();
  double gap = 0.0;  ///< between the body's lowest point and the plane, metres
  double friction = 0.0, restitution = 0.0;
};

double given(const std::optional<double>& own, double scene) { return own.value_or(scene); }

// how far the shape reaches from its centre against the normal, at its pose
double reach(const Body& body, const Vec3& normal) {
  if (const auto* sphere = body.shape->as<Sphere>()) return sphere->radius;
  const auto& box = *body.shape->as<Box>();
  return (body.pose.rotation.transpose() * normal).cwiseAbs().dot(box.half);
}

OnPlane on_plane(const std::string& name, const Session& session, bool wants_sphere) {
  const std::string wanted = fmt::format("one dynamic {} that doesn't spin and one static plane, and nothing else",
                                         wants_sphere ? "sphere" : "box");
  const auto& contact = session.world().parameters.contact;
  OnPlane scene;
  const Body* ground = nullptr;
  for (const Body& body : session.world().bodies()) {
    if (body.kind() == BodyKind::fixed && body.shape->as<Plane>() != nullptr && ground == nullptr)
      ground = &body;
    else if (body.as<RigidBody>() != nullptr && scene.body == nullptr &&
             (wants_sphere ? body.shape->as<Sphere>() != nullptr : body.shape->as<Box>() != nullptr))
      scene.body = body.as<RigidBody>();
    else
      unfit(name, fmt::format("body '{}' is a {} {}", body.name, kind_name(body.kind()), body.shape->name()), wanted);
  }
  if (scene.body == nullptr || ground == nullptr)
    unfit(name, scene.body == nullptr ? "the scene has no such body" : "the scene has no plane", wanted);
  if (scene.body->angular_momentum.norm() > 0.0) unfit(name, fmt::format("body '{}' spins", scene.body->name), wanted);
  const Plane& plane = *ground->shape->as<Plane>();
  scene.normal = ground->pose.rotation * plane.normal;
  scene.gap = scene.normal.dot(scene.body->pose.position - ground->pose.position) - plane.offset -
              reach(*scene.body, scene.normal);
  scene.friction = std::sqrt(given(scene.body->friction, contact.friction) * given(ground->friction, contact.friction));
  scene.restitution =
      std::max(given(scene.body->restitution, contact.restitution), given(ground->restitution, contact.restitution));
  return scene;
}

AnalyticMotion free_fall(const Session& session) {
  const Vec3 g = session.world().parameters.simulation.gravity;
  std::map<std::string, Vec3> velocities;
  for (const Body& body : session.world().bodies()) {
    if (!body.has_freedom()) continue;
    const auto* rigid = body.as<RigidBody>();
    if (rigid == nullptr)
      unfit("free_fall", fmt::format("body '{}' is deformable", body.name), "rigid bodies that don't spin");
    if (rigid->angular_momentum.norm() > 0.0)
      unfit("free_fall", fmt::format("body '{}' spins", body.name), "rigid bodies that don't spin");
    velocities[body.name] = rigid->velocity;
  }
  return {[=](const std::string& body, double t) { return Vec3(velocities.at(body) * t + 0.5 * g * t * t); }, true};
}

// along one line: friction against the motion, until it stops; then it stays unless gravity pulls harder than friction
// holds
AnalyticMotion sliding(const Session& session) {
  const OnPlane scene = on_plane("sliding", session, false);
  const Vec3 g = session.world().parameters.simulation.gravity, n = scene.normal, v = scene.body->velocity;
  const double press = -g.dot(n);
  const Vec3 pull = g - g.dot(n) * n;
  const Vec3 half = scene.body->shape->as<Box>()->half;
  const double speed = v.norm(), height = reach(*scene.body, n);
  if (std::abs(scene.gap) > 1e-3 * half.norm())
    unfit("sliding", fmt::format("the box is {:.3g} m off the plane", scene.gap), "a box that lies on the plane");
  if (press <= 0.0 || std::abs(v.dot(n)) > 1e-9 * speed)
    unfit("sliding", "the box leaves the plane", "gravity into the plane and a velocity along it");
  const bool lies = ((scene.body->pose.rotation.transpose() * n).cwiseAbs() - Vec3::Ones()).maxCoeff() > -1e-9;
  if (!lies) unfit("sliding", "the box stands on an edge or a corner", "a face on the plane");
  if (speed > 0.0 && pull.norm() > 1e-9 * press && pull.cross(v).norm() > 1e-9 * pull.norm() * speed)
    unfit("sliding", "the box slides askew to the slope", "a velocity up or down the slope");
  const Vec3 u = speed > 0.0 ? Vec3(v / speed) : pull.norm() > 0.0 ? Vec3(pull.normalized()) : Vec3(Vec3::Zero());
  const double hold = scene.friction * press, along = pull.dot(u);
  const double length = (scene.body->pose.rotation.transpose() * u).cwiseAbs().dot(half);
  if (scene.friction * height >= length)
    unfit("sliding", "the box tips over", "friction less than half length / half height");
  const std::string name = scene.body->name;
  const auto distance = [=](double t) {
    const double a = speed > 0.0 ? along - hold : std::max(0.0, along - hold);
    if (speed == 0.0 || a >= 0.0) return speed * t + 0.5 * a * t * t;
    const double stop = -speed / a;
    if (t <= stop) return speed * t + 0.5 * a * t * t;
    const double after = std::abs(along) <= hold ? 0.0 : along + (along < 0.0 ? hold : -hold);
    return 0.5 * speed * stop + 0.5 * after * (t - stop) * (t - stop);
  };
  return {[=](const std::string& body, double t) { return body == name ? Vec3(u * distance(t)) : Vec3(Vec3::Zero()); },
          false};
}

// parabolas; an impact slower than contact.restitution_threshold ends in rest
AnalyticMotion bouncing(const Session& session) {
  const OnPlane scene = on_plane("bouncing", session, true);
  const Vec3 g = session.world().parameters.simulation.gravity, n = scene.normal, v = scene.body->velocity;
  const double pull = -g.dot(n), start = v.dot(n), gap = scene.gap, e = scene.restitution,
               slow = session.world().parameters.contact.restitution_threshold.at(
                   speed_scale(scale_gravity(g), scene.body->size));
  if (pull <= 0.0 || (g + pull * n).norm() > 1e-9 * pull || (v - start * n).norm() > 1e-9 * (1.0 + v.norm()))
    unfit("bouncing", "the sphere moves along the plane", "gravity and velocity along the plane's normal");
  if (gap < 0.0) unfit("bouncing", "the sphere starts inside the plane", "a sphere above it");
  const std::string name = scene.body->name;
  const auto height = [=](double t) {
    double h = gap, w = start;
    for (;;) {
      const double impact = (w + std::sqrt(w * w + 2.0 * pull * h)) / pull;  // when it comes down
      if (t <= impact) return h + w * t - 0.5 * pull * t * t;
      const double speed = pull * impact - w;
      if (speed * e <= 0.0 || speed <= slow) return 0.0;
      t -= impact, h = 0.0, w = e * speed;
    }
  };
  return {[=](const std::string& body, double t) {
            return body == name ? Vec3(n * (height(t) - gap)) : Vec3(Vec3::Zero());
          },
          false};
}

}  // namespace

const std::vector<AnalyticCase>& analytic_cases() {
  static const std::vector<AnalyticCase> kCases = {
      {"free_fall", "rigid bodies that don't spin, until the first contact: a parabola each", free_fall},
      {"sliding",
       "a box that lies on a static plane, level or sloping: it slides along the slope, stops, and stays or slides on "
       "by Coulomb's law",
       sliding},
      {"bouncing",
       "a sphere above a static plane, moving along its normal: parabolas, each impact slower by the restitution, "
       "until it rests",
       bouncing},
  };
  return kCases;
}

std::string analytic_case_names() {
  std::string names;
  for (const AnalyticCase& c : analytic_cases()) names += (names.empty() ? "" : ", ") + c.name;
  return names;
}

AnalyticMotion analytic_motion(const std::string& name, const Session& session) {
  std::vector<std::string> names;
  for (const AnalyticCase& c : analytic_cases()) {
    if (c.name == name) return c.motion(session);
    names.push_back(c.name);
  }
  const std::string near = nearest_word(name, names);
  throw InputError(fmt::format("unknown case '{}'; allowed: {}; {}", name, analytic_case_names(),
                               near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near)));
}

}  // namespace impinge
