// VTK's files, for ParaView and whatever is built on VTK: three lists by time, each of which opens by itself.
//   surfaces.pvd     deformable.NNNNNN.vtu, rigid.NNNNNN.vtu: triangles; static.vtu: those that never move, once
//   tetrahedra.pvd   tetrahedra.NNNNNN.vtu: of deformable bodies, with their stress
//   contacts.pvd     contacts.NNNNNN.vtu: a point a contact
// A field that a part has not is missing in it, so that no made-up zeros get into a colour bar. `body` counts the
// scene's bodies from 0; bodies.csv has their names.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "engine/bodies/element_stress.hpp"
#include "engine/core/parallel.hpp"
#include "engine/io/file.hpp"
#include "viewer/export/export_bodies.hpp"
#include "viewer/export/exporter.hpp"
#include "viewer/export/frame_files.hpp"
#include "viewer/export/pvd_file.hpp"
#include "viewer/export/surface_fields.hpp"
#include "viewer/export/vtu_grid.hpp"
#include "viewer/layers/heat_map.hpp"

namespace impinge {

namespace {

constexpr std::size_t kElementsPerTask = 64;

const BodyRecord& of(const StepRecord& record, const ExportBody& body) {
  return record.bodies[static_cast<std::size_t>(body.body.value())];
}

/// The surfaces of several bodies as one grid, with what every part has.
class SurfaceGrid {
 public:
  void add(const ExportBody& body, std::span<const Vec3> vertices) {
    const auto first = static_cast<std::int64_t>(grid.points.size());
    grid.points.insert(grid.points.end(), vertices.begin(), vertices.end());
    for (const Triangle& t : body.surface->triangles) grid.add_cell(VtuCell::triangle, t, first);
    bodies_.insert(bodies_.end(), body.surface->triangles.size(), body.body.value());
  }
  void write(const std::filesystem::path& path) {
    grid.add_cell_field("body", bodies_);
    grid.write(path);
  }

  VtuGrid grid;

 private:
  std::vector<int> bodies_;
};

/// Metres per second, of the vertices of a surface.
std::vector<Vec3> surface_velocity(const BodyRecord& body, std::span<const Vec3> vertices) {
  std::vector<Vec3> velocity(vertices.size());
  if (body.deformable != nullptr) {
    interpolate(body.deformable->embedding, body.deformable->fem.rest(), body.deformable->velocity, velocity);
    return velocity;
  }
  for (std::size_t i = 0; i < velocity.size(); ++i)
    velocity[i] = body.velocity + body.angular_velocity.cross(vertices[i] - body.pose.position);
  return velocity;
}

std::vector<double> at_surface(const DeformableBody& body, HeatQuantity quantity) {
  return values_at_points(body.embedding, body.fem.rest(), node_average(body, heat_of_elements(body, quantity)));
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

class VtuExporter final : public Exporter {
 public:
  void begin(const ExportJob& job, const StepRecord& start) override;
  void add(const StepRecord& record) override;
  void finish() override;
  std::string result() const override;

 private:
  void write_once(const StepRecord& record);
  void add_surfaces(const StepRecord& record);
  void add_tetrahedra(const StepRecord& record);
  void add_contacts(const StepRecord& record);

  std::filesystem::path folder_;
  FrameFiles files_;
  PvdFile surfaces_, tetrahedra_, contacts_;
  std::vector<ExportBody> moving_, static_;
  std::vector<std::vector<Vec3>> start_;  // vertices of the moving ones, as loaded
  std::map<int, VecX> start_nodes_;       // by body
  std::string names_;                     // bodies.csv
  ContactFields contact_fields_;
  bool is_first_ = true;
};

void VtuExporter::begin(const ExportJob& job, const StepRecord& start) {
  folder_ = job.folder;
  files_ = FrameFiles(folder_, ".vtu");
  surfaces_ = PvdFile(folder_ / "surfaces.pvd");
  tetrahedra_ = PvdFile(folder_ / "tetrahedra.pvd");
  contacts_ = PvdFile(folder_ / "contacts.pvd");
  for (ExportBody& body : export_bodies(start, job.colors)) {
    if (!body.is_static()) start_.push_back(world_surface(body, start));
    (body.is_static() ? static_ : moving_).push_back(std::move(body));
  }
  names_ = "body,name,kind\n";
  for (std::size_t i = 0; i < start.bodies.size(); ++i)
    names_ += fmt::format("{},{},{}\n", i, start.bodies[i].name, kind_name(start.bodies[i].kind));
  for (const ExportBody& body : moving_)
    if (body.is_deformable()) start_nodes_[body.body] = of(start, body).deformable->position;
}

void VtuExporter::write_once(const StepRecord& record) {
  write_file(folder_ / "bodies.csv", names_);
  if (static_.empty()) return;
  SurfaceGrid part;
  for (const ExportBody& body : static_)
    if (there(body, record) != nullptr) part.add(body, world_surface(body, record));
  part.write(files_.of_all("static"));
}

void VtuExporter::add_surfaces(const StepRecord& record) {
  std::vector<std::vector<Vec3>> vertices;
  for (const ExportBody& body : moving_)
    vertices.push_back(there(body, record) != nullptr ? world_surface(body, record) : std::vector<Vec3>());
  const std::vector<ContactField> contacts = contact_fields_.find(moving_, vertices, record);
  int part = 0;
  const double time = record.stats.time;
  for (const bool deformable : {true, false}) {
    SurfaceGrid surface;
    std::vector<Vec3> displacement, velocity, impulse;
    std::vector<double> gap, stress, strain;
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      if (moving_[i].is_deformable() != deformable) continue;
      if (there(moving_[i], record) == nullptr) continue;
      const BodyRecord& body = of(record, moving_[i]);
      surface.add(moving_[i], vertices[i]);
      for (std::size_t v = 0; v < vertices[i].size(); ++v) displacement.push_back(vertices[i][v] - start_[i][v]);
      append(velocity, surface_velocity(body, vertices[i]));
      append(impulse, contacts[i].impulse);
      append(gap, contacts[i].gap);
      if (!deformable) continue;
      append(stress, at_surface(*body.deformable, HeatQuantity::von_mises));
      append(strain, at_surface(*body.deformable, HeatQuantity::equivalent_strain));
    }
    if (displacement.empty()) continue;
    surface.grid.add_point_field("displacement", displacement);
    surface.grid.add_point_field("velocity", velocity);
    surface.grid.add_point_field("contact_impulse", impulse);
    surface.grid.add_point_field("gap", gap);
    if (deformable) {
      surface.grid.add_point_field("von_mises_stress", stress);
      surface.grid.add_point_field("equivalent_strain", strain);
    }
    const std::filesystem::path path = files_.of_frame(deformable ? "deformable" : "rigid", record.stats.frame);
    surface.write(path);
    surfaces_.add(time, part++, path);
  }
  if (!static_.empty()) surfaces_.add(time, part, files_.of_all("static"));
}

void VtuExporter::add_tetrahedra(const StepRecord& record) {
  VtuGrid grid;
  std::vector<Vec3> displacement, velocity;
  std::vector<double> stress, mises, strain, ratio;
  std::vector<int> held, bodies;
  for (const auto& [index, start] : start_nodes_) {
    if (index >= std::ssize(record.bodies) || record.bodies[static_cast<std::size_t>(index)].deleted) continue;
    const DeformableBody& body = *record.bodies[static_cast<std::size_t>(index)].deformable;
    const auto first = static_cast<std::int64_t>(grid.points.size());
    for (int n = 0; n < body.nodes(); ++n) {
      const Vec3 x = body.position.segment<3>(3 * n);
      grid.points.push_back(x);
      displacement.push_back(x - start.segment<3>(3 * n));
      velocity.push_back(body.velocity.segment<3>(3 * n));
      held.push_back(body.is_held(n) ? 1 : 0);
    }
    const std::vector<Tet>& tets = body.fem.rest().tets;
    std::vector<ElementState> states(tets.size());
    parallel_for(tets.size(), kElementsPerTask,
                 [&](std::size_t e) { states[e] = element_state(body, static_cast<int>(e)); });
    for (std::size_t e = 0; e < tets.size(); ++e) {
      grid.add_cell(VtuCell::tetrahedron, tets[e], first);
      const Mat3& s = states[e].stress;
      stress.insert(stress.end(), {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)});  // VTK's order
      mises.push_back(von_mises(s));
      strain.push_back(equivalent_strain(states[e].stretch));
      ratio.push_back(states[e].volume_ratio);
      bodies.push_back(index);
    }
  }
  grid.add_point_field("displacement", displacement);
  grid.add_point_field("velocity", velocity);
  grid.add_point_field("held", held);
  grid.add_cell_field("stress", stress, 6);
  grid.add_cell_field("von_mises_stress", mises);
  grid.add_cell_field("equivalent_strain", strain);
  grid.add_cell_field("volume_ratio", ratio);
  grid.add_cell_field("body", bodies);
  const std::filesystem::path path = files_.of_frame("tetrahedra", record.stats.frame);
  grid.write(path);
  tetrahedra_.add(record.stats.time, 0, path);
}

void VtuExporter::add_contacts(const StepRecord& record) {
  VtuGrid grid;
  std::vector<Vec3> point_a, point_b, normal, impulse;
  std::vector<double> gap, friction;
  std::vector<int> state, body_a, body_b;
  for (const ContactRecord& c : record.contacts) {
    grid.points.emplace_back(0.5 * (c.point_a + c.point_b));
    grid.add_vertex_cell();
    point_a.push_back(c.point_a), point_b.push_back(c.point_b), normal.push_back(c.normal);
    impulse.push_back(world_impulse(c));
    gap.push_back(c.gap), friction.push_back(c.friction);
    state.push_back(static_cast<int>(c.state));
    body_a.push_back(c.body_a.value()), body_b.push_back(c.body_b.value());
  }
  grid.add_point_field("point_a", point_a);
  grid.add_point_field("point_b", point_b);
  grid.add_point_field("normal", normal);
  grid.add_point_field("impulse", impulse);
  grid.add_point_field("gap", gap);
  grid.add_point_field("friction", friction);
  grid.add_point_field("state", state);
  grid.add_point_field("body_a", body_a);
  grid.add_point_field("body_b", body_b);
  const std::filesystem::path path = files_.of_frame("contacts", record.stats.frame);
  grid.write(path);
  contacts_.add(record.stats.time, 0, path);
}

void VtuExporter::add(const StepRecord& record) {
  if (is_first_) write_once(record);
  is_first_ = false;
  add_surfaces(record);
  if (!start_nodes_.empty()) add_tetrahedra(record);
  add_contacts(record);
}

void VtuExporter::finish() {
  for (const PvdFile* list : {&surfaces_, &tetrahedra_, &contacts_})
    if (!list->is_empty()) list->write();
  files_.remove_others();
}

std::string VtuExporter::result() const {
  std::string names;
  for (const PvdFile* list : {&surfaces_, &tetrahedra_, &contacts_})
    if (!list->is_empty()) names += (names.empty() ? "" : ", ") + list->path().string();
  return names;
}

}  // namespace

Entry<Exporter> vtu_exporter() {
  return entry<Exporter, VtuExporter>(
      "vtu", "VTK and ParaView: surfaces, tetrahedra and contacts with their fields, and .pvd lists with the times");
}

}  // namespace impinge
