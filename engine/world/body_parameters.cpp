// The rows `body.NAME.*`: what of a body may change between frames.
#include "engine/world/world_stages.hpp"

namespace impinge {
namespace {
constexpr double kFar = 1e9;
constexpr double kInherited = -1.0;  // of a body's coefficient
constexpr const char* kInherit = "scene";
}  // namespace

void World::bind_bodies(ParameterSet& set) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    // by index: the vector may grow; a change of state wakes everyone, since a sleeper's neighbours can't know of it
    const auto body = [this, i]() -> RigidBody& { return bodies_[i]; };
    const auto state = [this, body](auto change) {
      stages_->sleeping.wake_all(bodies_);
      change(body());
      body().update_world_vertices();
    };
    const std::string path = "body." + bodies_[i].name + ".";
    const auto coefficient = [&](const char* name, double high, const char* doc, double RigidBody::*member) {
      const auto get = [body, member] {
        return body().*member == kInherited ? ParameterValue(kInherit) : ParameterValue(body().*member);
      };
      Parameter row;
      row.path = path + name;
      row.range = {0.0, high};
      row.inherit = kInherit;
      row.doc = doc;
      row.initial = get();
      row.get = get;
      row.set = [body, member](const ParameterValue& v) {
        const double* own = std::get_if<double>(&v);
        body().*member = own == nullptr ? kInherited : *own;
      };
      set.add(row);
    };
    coefficient("friction", 100.0, "Coulomb coefficient; scene: contact.friction.", &RigidBody::friction);
    coefficient("restitution", 1.0, "Restitution; scene: contact.restitution.", &RigidBody::restitution);
    if (bodies_[i].soft) bind_soft_body(set, static_cast<int>(i), path);
    if (!bodies_[i].is_dynamic()) continue;
    const auto vector = [&](const char* name, const char* unit, double limit, const char* doc, auto get, auto put) {
      set.add({path + name,
               ParameterKind::vector3,
               unit,
               {-limit, limit},
               {},
               doc,
               ParameterValue(Vec3(get(body()))),
               [body, get] { return ParameterValue(Vec3(get(body()))); },
               [state, put](const ParameterValue& v) { state([&](RigidBody& b) { put(b, std::get<Vec3>(v)); }); }});
    };
    vector(
        "position", "m", kFar, "Where the origin of the body's file (or shape) is.",
        [](const RigidBody& b) { return b.file_pose().position; },
        [](RigidBody& b, const Vec3& x) { b.pose.position = x + b.pose.rotation * b.center; });
    vector(
        "rotation", "deg", 1e6,
        "About x, then y, then z (fixed axes), round the file's origin; the angular velocity stays.",
        [](const RigidBody& b) { return degrees_from_rotation(b.pose.rotation); },
        [](RigidBody& b, const Vec3& degrees) {
          const Vec3 origin = b.file_pose().position, w = b.angular_velocity();
          b.pose.rotation = rotation_from_degrees(degrees);
          b.pose.position = origin + b.pose.rotation * b.center;
          b.angular_momentum = b.world_inertia() * w;
        });
    vector(
        "velocity", "m/s", 1e6, "Of the centre of mass.", [](const RigidBody& b) { return b.velocity; },
        [](RigidBody& b, const Vec3& v) { b.velocity = v; });
    vector(
        "angular_velocity", "rad/s", 1e6, "Angular velocity, world axes.",
        [](const RigidBody& b) { return b.angular_velocity(); },
        [](RigidBody& b, const Vec3& w) { b.angular_momentum = b.world_inertia() * w; });
  }
}

void World::bind_soft_body(ParameterSet& set, int index, const std::string& path) {
  const auto soft = [this, index]() -> SoftBody& { return *bodies_[index].soft; };
  const auto changed = [this] { stages_->sleeping.wake_all(bodies_); };
  ParameterSet of_material;
  soft().material->declare(Rows(of_material, path + "material"));
  for (Parameter row : of_material.all()) {
    row.set = [set_value = row.set, changed](const ParameterValue& v) {
      set_value(v);
      changed();
    };
    set.add(std::move(row));
  }
  const auto damping = [&](const char* name, double high, const char* unit, const char* doc,
                           double RayleighDamping::*member) {
    set.add({path + name,
             ParameterKind::real,
             unit,
             {0.0, high, true},
             {},
             doc,
             soft().fem.damping.*member,
             [soft, member] { return ParameterValue(soft().fem.damping.*member); },
             [soft, member, changed](const ParameterValue& v) {
               soft().fem.damping.*member = std::get<double>(v);
               changed();
             }});
  };
  damping("material.damping_alpha", 1e6, "1/s", "Rayleigh damping in proportion to mass.", &RayleighDamping::alpha);
  damping("material.damping_beta", 1e3, "s", "Rayleigh damping in proportion to stiffness.", &RayleighDamping::beta);
  for (std::size_t r = 0; r < soft().held.size(); ++r) {
    const auto region = [soft, r]() -> HeldRegion& { return soft().held[r]; };
    set.add({path + "fixed_" + std::to_string(r) + ".displacement",
             ParameterKind::vector3,
             "m",
             {-kFar, kFar},
             {},
             "Where held nodes of this region are moved to, from where they would be: reached evenly by the end of the "
             "frame.",
             ParameterValue(region().wanted),
             [region] { return ParameterValue(region().wanted); },
             [region, changed](const ParameterValue& v) {
               region().wanted = std::get<Vec3>(v);
               changed();
             }});
  }
}

}  // namespace impinge
