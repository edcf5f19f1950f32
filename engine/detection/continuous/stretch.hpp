// A moving surface between two moments: where its boxes and vertices are at both, and when two such boxes meet.
#pragma once

#include <algorithm>
#include <optional>

#include "engine/detection/continuous/surface_path.hpp"
#include "engine/geometry/box_tree.hpp"

namespace impinge {

/// One surface at the two ends of an interval of time.
class Stretch {
 public:
  Stretch(const SurfacePath& path, double t0, double t1) : path_(&path), tree_(&path.of->surface->tree()), t_{t0, t1} {
    if (path.is_rigid()) {
      for (int k : {0, 1}) pose_[k] = path.pose_at(t_[k]), turned_[k] = pose_[k].rotation.cwiseAbs();
    } else {
      const TriangleMesh& mesh = path.of->surface->mesh;
      for (int k : {0, 1}) {
        moved_[k].resize(path.start.size());
        for (std::size_t v = 0; v < path.start.size(); ++v)
          moved_[k][v] = path.start[v] + t_[k] * (path.end[v] - path.start[v]);
        tree_->fit(triangle_boxes(mesh.triangles, moved_[k]), fitted_[k]);
      }
    }
  }

  const SurfacePath& path() const { return *path_; }
  const BoxTree::Node& node(int n) const { return tree_->nodes()[n]; }
  int triangle(int i) const { return tree_->order()[i]; }
  /// At the interval's start (0) or end (1).
  Vec3 vertex(int v, int k) const {
    return path_->is_rigid() ? pose_[k].apply(path_->of->surface->mesh.vertices[v]) : moved_[k][v];
  }
  /// On the path itself, at a time of it.
  Vec3 position(int v, double time) const {
    if (!path_->is_rigid()) return path_->start[v] + time * (path_->end[v] - path_->start[v]);
    if (time != asked_) asked_ = time, pose_then_ = path_->pose_at(time);
    return pose_then_.apply(path_->of->surface->mesh.vertices[v]);
  }
  Aabb box(int n, int k) const {
    if (!path_->is_rigid()) return fitted_[k][n];
    const Aabb& local = node(n).box;
    const Vec3 center = pose_[k].apply(local.center()), half = product(turned_[k], 0.5 * local.extent());
    return {center - half, center + half};
  }

 private:
  const SurfacePath* path_;
  const BoxTree* tree_;
  double t_[2];
  Pose pose_[2];
  Mat3 turned_[2];
  std::vector<Vec3> moved_[2];
  std::vector<Aabb> fitted_[2];
  // what is asked of a time is asked of many vertices at once; one thread at a time has a stretch
  mutable double asked_ = -1.0;
  mutable Pose pose_then_;
};

/// When two boxes whose faces move evenly first meet, in [0, 1].
inline std::optional<double> meeting(const Aabb& a0, const Aabb& a1, const Aabb& b0, const Aabb& b1, double margin) {
  double from = 0.0, to = 1.0;
  const auto below = [&](double l0, double l1) {  // l(t) <= margin
    l0 -= margin, l1 -= margin;
    if (l0 > 0.0 && l1 > 0.0) return false;
    if (l0 > 0.0) from = std::max(from, l0 / (l0 - l1));
    if (l1 > 0.0) to = std::min(to, l0 / (l0 - l1));
    return true;
  };
  for (int k = 0; k < 3; ++k)
    if (!below(a0.min[k] - b0.max[k], a1.min[k] - b1.max[k]) || !below(b0.min[k] - a0.max[k], b1.min[k] - a1.max[k]))
      return std::nullopt;
  if (from > to + 1e-12) return std::nullopt;
  return std::max(0.0, from - 1e-12);
}

}  // namespace impinge
