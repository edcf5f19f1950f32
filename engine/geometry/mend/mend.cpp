#include "engine/geometry/mend/mend.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/interrupt.hpp"
#include "engine/geometry/aabb.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/clean_triangles.hpp"
#include "engine/geometry/mend/fill_holes.hpp"
#include "engine/geometry/mend/remesh.hpp"
#include "engine/geometry/mend/sheets.hpp"
#include "engine/geometry/mend/split_borders.hpp"
#include "engine/geometry/mend/winding_tree.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/geometry/surface/mesh_shells.hpp"
#include "engine/geometry/surface/thickened_surface.hpp"

namespace impinge {
namespace {

constexpr double kWeldOfDiagonal = 1e-6, kThicknessOfSide = 1e-2;
constexpr int kMostRounds = 100;
constexpr double kDoubled =
    1e-9;  // of the area to the power of 3/2: a closed part of less volume is a sheet laid double

double area_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    area += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
  }
  return area;
}

bool is_flat(const TriangleMesh& closed) {
  return std::abs(signed_volume(closed)) <= kDoubled * std::pow(area_of(closed), 1.5);
}

std::vector<TriangleMesh> parts_of(const TriangleMesh& mesh) {
  int count = 0;
  const std::vector<int> label = label_parts(mesh, make_topology(mesh), count);
  std::vector<TriangleMesh> parts(static_cast<std::size_t>(count));
  // after make_sheets a vertex belongs to one part
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < label.size(); ++t) {
    TriangleMesh& part = parts[label[t]];
    Triangle own = mesh.triangles[t];
    for (int& v : own) {
      if (index[v] < 0) index[v] = static_cast<int>(part.vertices.size()), part.vertices.push_back(mesh.vertices[v]);
      v = index[v];
    }
    part.triangles.push_back(own);
  }
  return parts;
}

/// The mesh without vertices that no triangle has.
TriangleMesh without_unused(const TriangleMesh& mesh) {
  TriangleMesh left;
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) used[v] = 1;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) index[v] = static_cast<int>(left.vertices.size()), left.vertices.push_back(mesh.vertices[v]);
  for (const Triangle& t : mesh.triangles) left.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
  return left;
}

class Mender {
 public:
  Mender(TriangleMesh mesh, const MendSettings& settings) : mesh_(std::move(mesh)), settings_(settings) {
    if (!mesh_.triangles.empty()) report_.volume_before = signed_volume(mesh_);
  }

  MendedMesh run() {
    join_and_drop();
    cut_and_close();
    if (settings_.orient && !mesh_.triangles.empty() && make_topology(mesh_).is_closed()) face_outwards();
    if (settings_.remesh > 0) take_walls();
    add_sheets();
    if (report_.sheets > 0 && settings_.orient) face_outwards();  // sheets lie in others' thickness
    if (settings_.remesh > 0 && (!mesh_.triangles.empty() || !walls_.triangles.empty())) {
      const bool was_solid = walls_.triangles.empty() && report_.sheets == 0;  // else it is another solid in any case
      const TriangleMesh before = was_solid ? mesh_ : TriangleMesh();
      mesh_ = remesh(mesh_, walls_, settings_.remesh, &report_.largest_move);
      if (was_solid && !mesh_.triangles.empty()) report_.skin_fault = skin_fault(before, mesh_, settings_.remesh);
      report_.remeshed = true;
    }
    MendedMesh result{std::move(mesh_), report_, std::nullopt};
    if (result.mesh.triangles.empty()) {
      result.problem = settings_.remesh > 0 ? "has no part as thick as a cell; remesh with more cells"
                                            : "encloses nothing: no triangle with an area is left; export it again";
      return result;
    }
    result.problem = check_mesh(result.mesh, make_topology(result.mesh));
    result.report.volume_after = signed_volume(result.mesh);
    return result;
  }

 private:
  void join_and_drop() {
    if (settings_.drop_degenerate) report_.collapsed += drop_collapsed(mesh_);
    // a tolerance of 0 welds nothing at all: the file's vertices are as they are meant
    if (settings_.weld != 0.0 && !mesh_.triangles.empty() && !make_topology(mesh_).is_closed()) {
      WeldedMesh exact = weld(mesh_);
      report_.welded += static_cast<int>(mesh_.vertices.size() - exact.mesh.vertices.size());
      report_.collapsed += static_cast<int>(mesh_.triangles.size() - exact.mesh.triangles.size());
      mesh_ = std::move(exact.mesh);
      const double tolerance = settings_.weld
                                   ? *settings_.weld
                                   : closing_tolerance(mesh_, kWeldOfDiagonal * bounds_of(mesh_).extent().norm());
      const BorderWeld near = weld_borders(mesh_, tolerance);
      report_.welded += near.welded;
      report_.collapsed += near.collapsed;
      const SplitBorders split = split_borders(mesh_, tolerance);
      report_.split_edges = split.edges;
      report_.largest_move = std::max(near.largest_move, split.largest_move);
    }
    if (!settings_.drop_degenerate) return;
    report_.collapsed += drop_collapsed(mesh_);  // what cutting edges made of triangles
    report_.duplicates = drop_duplicates(mesh_);
    take_out_flat(mesh_);
  }

  /// A triangle that is a line between others that are lines too is reached from the one at their end.
  void take_out_flat(TriangleMesh& mesh) {
    report_.joined += join_coincident(mesh);
    for (int round = 0; round < kMostRounds; ++round) {
      const int flips = flip_flat(mesh);
      if (flips == 0) return;
      report_.flipped_flat += flips;
    }
  }

  /// Leaves the closed parts in mesh_ and the open ones, which are to be sheets, in sheets_.
  void cut_and_close() {
    const SheetCounts cut = make_sheets(mesh_, settings_.orient);
    report_.turned = cut.turned;
    report_.cut_edges = cut.cut_edges;
    report_.added_vertices = cut.added_vertices;
    const std::vector<TriangleMesh> parts = parts_of(mesh_);
    bool all_whole = true;
    TriangleMesh solid;
    for (const TriangleMesh& part : parts) {
      check_interrupt();
      const MeshTopology topology = make_topology(part);
      TriangleMesh closed = part;
      if (topology.border_edges > 0) {
        all_whole = false;
        if (!close(part, topology, closed)) {
          sheets_.push_back(part);
          continue;
        }
      } else if (is_flat(part)) {
        ++report_.flat_parts;
        all_whole = false;
        continue;
      }
      append(solid, closed);
    }
    if (!all_whole) mesh_ = std::move(solid);  // else as it is, its vertices in their order
  }

  bool close(const TriangleMesh& part, const MeshTopology& topology, TriangleMesh& closed) {
    if (!settings_.fill_holes) return false;
    const std::vector<Hole> holes = find_holes(part, topology);
    double open = 0.0;
    int triangles = 0;
    for (const Hole& hole : holes) open += hole.area, triangles += static_cast<int>(hole.filling.size());
    if (open > settings_.largest_hole * area_of(part)) return false;
    fill(closed, holes);
    if (settings_.drop_degenerate) take_out_flat(closed);  // a slit is filled with what has no area
    if (make_topology(closed).border_edges > 0 || is_flat(closed)) return false;
    report_.holes += static_cast<int>(holes.size());
    report_.hole_triangles += triangles;
    return true;
  }

  /// From the outermost parts inwards. What faces inwards inside of a solid is a cavity's wall; what faces outwards
  /// there is a part of its own that adds nothing. In a file that is inside out it is the other way about.
  void face_outwards() {
    const std::vector<Shell> shells = find_shells(mesh_, make_topology(mesh_));
    std::vector<int> order(shells.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int l, int r) { return shells[l].depth < shells[r].depth; });
    enum { kept, turned, dropped };
    std::vector<char> fate(shells.size(), kept), solid_inside(shells.size(), 1), everted(shells.size(), 0);
    for (const int s : order) {
      const Shell& shell = shells[s];
      const bool in_solid = shell.container >= 0 && solid_inside[shell.container] != 0;
      everted[s] = shell.container >= 0 ? everted[shell.container] : static_cast<char>(shell.volume < 0.0);
      const bool is_wall = in_solid && ((shell.volume < 0.0) != (everted[s] != 0) || !settings_.drop_inner);
      if (in_solid && !is_wall) {
        fate[s] = dropped;
      } else {
        solid_inside[s] = is_wall ? 0 : 1;
        fate[s] = (shell.volume < 0.0) == is_wall ? kept : turned;
      }
      report_.turned_parts += fate[s] == turned ? 1 : 0;
      report_.inner_parts += fate[s] == dropped ? 1 : 0;
    }
    if (report_.turned_parts + report_.inner_parts == 0) return;
    std::vector<char> of_triangle(mesh_.triangles.size(), kept);
    for (std::size_t s = 0; s < shells.size(); ++s)
      for (const int t : shells[s].triangles) of_triangle[t] = fate[s];
    std::vector<Triangle> triangles;
    for (std::size_t t = 0; t < of_triangle.size(); ++t) {
      Triangle own = mesh_.triangles[t];
      if (of_triangle[t] == turned) std::swap(own[1], own[2]);
      if (of_triangle[t] != dropped) triangles.push_back(own);
    }
    mesh_.triangles = std::move(triangles);
    if (report_.inner_parts > 0) mesh_ = without_unused(mesh_);
  }

  /// Of a new skin: open parts that enclose something together need no thickness of their own.
  void take_walls() {
    if (sheets_.empty()) return;
    TriangleMesh all = mesh_;
    for (const TriangleMesh& sheet : sheets_) append(all, sheet);
    const double cell = bounds_of(all).extent().maxCoeff() / settings_.remesh;
    const WindingTree winding(all.triangles, all.vertices);
    TriangleMesh walls = mesh_;
    const std::size_t taken = std::erase_if(sheets_, [&](const TriangleMesh& sheet) {
      if (!is_wall(sheet, winding, cell)) return false;
      append(walls, sheet);
      return true;
    });
    if (taken > 0) walls_ = std::move(walls);
    thinnest_ = 2.0 * cell;  // of other sheets, or a skin on that lattice has holes
  }

  /// Whether most of its area has an inside within a cell of one side, and none of the other.
  static bool is_wall(const TriangleMesh& sheet, const WindingTree& winding, double cell) {
    double area = 0.0, wall = 0.0;
    for (const Triangle& t : sheet.triangles) {
      const Vec3 &a = sheet.vertices[t[0]], &b = sheet.vertices[t[1]], &c = sheet.vertices[t[2]];
      const Vec3 twice = (b - a).cross(c - a), middle = (a + b + c) / 3.0, off = cell * twice.normalized();
      area += twice.norm();
      if (winding.winds_round(middle + off) != winding.winds_round(middle - off)) wall += twice.norm();
    }
    return wall > 0.5 * area;
  }

  /// Open parts as thin solids; those inside of the closed ones add nothing.
  void add_sheets() {
    if (sheets_.empty()) return;
    const TriangleMesh solid = mesh_;
    const WindingTree winding(solid.triangles, solid.vertices);
    for (const TriangleMesh& sheet : sheets_) {
      check_interrupt();
      const bool is_inside = !solid.triangles.empty() && settings_.drop_inner &&
                             std::all_of(sheet.vertices.begin(), sheet.vertices.end(),
                                         [&](const Vec3& x) { return winding.is_inside(x); });
      if (is_inside) {
        ++report_.inner_parts;
        continue;
      }
      ThinSurface how;
      how.thickness =
          settings_.thickness.value_or(std::max(thinnest_, kThicknessOfSide * bounds_of(sheet).extent().maxCoeff()));
      if (!(*how.thickness > 0.0) || !(area_of(sheet) > 0.0)) {
        ++report_.flat_parts;
        continue;
      }
      const TriangleMesh thin = thickened(sheet, how);
      if (!make_topology(thin).is_closed() || is_flat(thin)) {
        ++report_.flat_parts;
        continue;
      }
      report_.largest_move = std::max(report_.largest_move, 0.5 * *how.thickness);
      ++report_.sheets;
      append(mesh_, thin);
    }
  }

  TriangleMesh mesh_;
  std::vector<TriangleMesh> sheets_;
  TriangleMesh walls_;     // of a new skin: the solid and what encloses something beside it; empty: nothing does
  double thinnest_ = 0.0;  // metres, of a sheet
  MendSettings settings_;
  MendReport report_;
};

}  // namespace

MendedMesh mend(TriangleMesh mesh, const MendSettings& settings) { return Mender(std::move(mesh), settings).run(); }

}  // namespace impinge
