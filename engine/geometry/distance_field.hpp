// How far a surface is, at least, from a point: distances at the voxels of a narrow band round it, in a sparse grid
// [Museth13]. Every bound is certain: values are exact and rounded down, and what a point is away from its voxel is taken off.
#pragma once

#include <memory>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/sparse_voxels.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class DistanceField {
 public:
  /// The finest band of at most `most_voxels` round the surface; no voxel is smaller than a quarter of the mean edge.
  /// Throws Interrupted, and InputError as make_sparse_voxels does.
  DistanceField(const SurfaceMesh& surface, std::size_t most_voxels);

  std::size_t most_voxels() const { return most_voxels_; }
  std::size_t voxels() const { return voxels_; }
  double voxel_size() const { return size_; }  ///< metres
  /// Farther from the surface all points have this bound inside its box; metres.
  double reach() const;

  /// Looks points up; remembers where the last one was, so each thread has its own.
  class Reader {
   public:
    explicit Reader(const DistanceField& field);
    /// x in the mesh's frame. No point of the surface is nearer, metres; 0 if that is all there is to say.
    double at_least(const Vec3& x);

   private:
    const DistanceField& field_;
    std::unique_ptr<SparseVoxels::Reader> values_;  // null: there is no surface
  };

 private:
  /// The band with voxels of size_; false: it has more than it may.
  bool make_band(const TriangleMesh& mesh);
  void take_distances(const SurfaceMesh& surface);

  std::size_t most_voxels_, voxels_ = 0;
  double size_ = 0.0;
  Aabb bounds_;
  Vec3 origin_ = Vec3::Zero();  // of voxel (0, 0, 0)'s centre
  std::unique_ptr<SparseVoxels> band_;
};

}  // namespace impinge
