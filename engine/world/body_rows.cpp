// The rows `body.NAME.*`: what of a body can be asked for by path, and changed between frames.
#include "engine/bodies/body_keys.hpp"
#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/rigid_body.hpp"
#include "engine/core/rows.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/world/world.hpp"

namespace impinge {
namespace {

/// Declares one body's rows. A change of state wakes everyone, since a sleeper's neighbours can't know of it.
class BodyRows {
 public:
  BodyRows(ParameterSet& set, Body& body, std::function<void()> wake)
      : set_(set), body_(body), wake_(std::move(wake)), path_("body." + body.name) {}

  void declare() {
    coefficient("friction", &Body::friction);
    coefficient("restitution", &Body::restitution);
    if (auto* rigid = body_.as<RigidBody>()) declare_rigid(*rigid);
    if (auto* deformable = body_.as<DeformableBody>()) declare_deformable(*deformable);
    if (body_.has_freedom() || body_.absent)  // such bodies alone are added
      set_.add(body_row(
          path_, "mass", [b = &body_] { return ParameterValue(b->mass); }, nullptr));
  }

 private:
  using Optional = std::optional<double>;

  void coefficient(const char* name, Optional Body::*member) {
    const std::string word(body_key(name).word);
    set_.add(body_row(
        path_, name,
        [b = &body_, member, word] {
          const Optional& own = b->*member;
          return own ? ParameterValue(*own) : ParameterValue(word);
        },
        [b = &body_, member](const ParameterValue& v) {
          const double* own = std::get_if<double>(&v);
          b->*member = own == nullptr ? Optional() : Optional(*own);
        }));
  }

  template <class Kind, class Get, class Put>
  void vector(Kind& body, const char* name, Get get, Put put) {
    set_.add(body_row(
        path_, name, [b = &body, get] { return ParameterValue(Vec3(get(*b))); },
        [b = &body, put, wake = wake_](const ParameterValue& v) {
          wake();
          put(*b, std::get<Vec3>(v));
          b->update_world_vertices();
        }));
  }

  void declare_rigid(RigidBody& body) {
    vector(
        body, "position", [](const RigidBody& b) { return b.file_pose().position; },
        [](RigidBody& b, const Vec3& x) { b.pose.position = x + b.pose.rotation * b.center; });
    vector(
        body, "rotation", [](const RigidBody& b) { return degrees_from_rotation(b.pose.rotation); },
        [](RigidBody& b, const Vec3& degrees) {
          const Vec3 origin = b.file_pose().position, w = b.angular_velocity();
          b.pose.rotation = rotation_from_degrees(degrees);
          b.pose.position = origin + b.pose.rotation * b.center;
          b.angular_momentum = b.world_inertia() * w;
        });
    vector(
        body, "velocity", [](const RigidBody& b) { return b.velocity; },
        [](RigidBody& b, const Vec3& v) { b.velocity = v; });
    vector(
        body, "angular_velocity", [](const RigidBody& b) { return b.angular_velocity(); },
        [](RigidBody& b, const Vec3& w) { b.angular_momentum = b.world_inertia() * w; });
  }

  void declare_deformable(DeformableBody& body) {
    ParameterSet of_material;
    body.material->declare(Rows(of_material, path_ + ".material"));
    for (Parameter row : of_material.all()) {
      row.set = [set_value = row.set, wake = wake_](const ParameterValue& v) {
        set_value(v);
        wake();
      };
      set_.add(std::move(row));
    }
    Parameter element;
    element.path = path_ + ".material.element";
    element.kind = ParameterKind::choice;
    for (const auto& [kind, word] : element_words()) element.names.push_back(word);
    element.doc =
        "Shape functions of the tetrahedra: quadratic ones neither lock in bending nor towards poisson = 0.5.";
    element.get = [b = &body] { return ParameterValue(word_of(element_words(), b->fem.element_kind())); };
    element.initial = element.get();
    element.live = false;
    set_.add(std::move(element));
    const auto damping = [&](const char* name, double RayleighDamping::*member) {
      set_.add(body_row(
          path_, name, [b = &body, member] { return ParameterValue(b->damping.*member); },
          [b = &body, member, wake = wake_](const ParameterValue& v) {
            b->damping.*member = std::get<double>(v);
            wake();
          }));
    };
    damping("material.damping_alpha", &RayleighDamping::alpha);
    damping("material.damping_beta", &RayleighDamping::beta);
    set_.add(body_row(
        path_, "self_collision", [b = &body] { return ParameterValue(b->self_collision); }, nullptr));
    set_.add(body_row(
        path_, "self_exempt_distance",
        [b = &body, word = std::string(body_key("self_exempt_distance").word)] {
          return b->self_exempt_distance ? ParameterValue(*b->self_exempt_distance) : ParameterValue(word);
        },
        nullptr));
    for (std::size_t r = 0; r < body.held.size(); ++r) declare_held(body, r);
  }

  void declare_held(DeformableBody& body, std::size_t r) {
    Parameter row;
    row.path = path_ + ".fixed_" + std::to_string(r) + ".displacement";
    row.kind = ParameterKind::vector3;
    row.unit = "m";
    row.range = body_key("position").range;
    row.doc =
        "Where held nodes of this region are moved to, from where they would be: reached evenly by the end of the "
        "frame.";
    row.get = [b = &body, r] { return ParameterValue(b->held[r].wanted); };
    row.initial = row.get();
    row.set = [b = &body, r, wake = wake_](const ParameterValue& v) {
      b->held[r].wanted = std::get<Vec3>(v);
      wake();
    };
    set_.add(std::move(row));
  }

  ParameterSet& set_;
  Body& body_;
  std::function<void()> wake_;
  std::string path_;
};

}  // namespace

void World::bind_bodies(ParameterSet& set) {
  for (Body& body : bodies_) bind_body(set, body);
}

void World::bind_body(ParameterSet& set, Body& body) {
  const auto wake = [this] {
    sleeping_.wake_all(bodies_);
    look_at_all();
  };
  BodyRows(set, body, wake).declare();
}

}  // namespace impinge
