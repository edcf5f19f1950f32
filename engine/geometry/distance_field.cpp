#ifdef IMPINGE_OPENVDB
#include "engine/geometry/distance_field.hpp"

#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/nearest_triangle.hpp"

namespace impinge {
namespace {

constexpr int kLayers = 3;           // of voxels beyond those that the surface goes through, to either side
constexpr double kVoxelsAFace = 11;  // that a band of so many layers has over a voxel's face of surface, or so
constexpr double kHalfDiagonal = 0.8660254037844387;  // of a unit cube
constexpr int kFewVoxels = 4;  // a side: of the box of a piece of a triangle that is looked at voxel by voxel

double area_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

VoxelIndex nearest_voxel(const Vec3& in_voxels) {
  const auto round = [](double x) { return static_cast<int>(std::lround(x)); };
  return {round(in_voxels.x()), round(in_voxels.y()), round(in_voxels.z())};
}

Vec3 center_of(const VoxelIndex& voxel) { return Vec3(voxel[0], voxel[1], voxel[2]); }

/// Makes active at least the voxels whose cubes a triangle touches; all lengths in voxels.
void mark(SparseVoxels& band, const TriangleCorners& c, InterruptPoll& poll) {
  constexpr double kSlack = 1e-6;  // rounding, of coordinates up to a thousand million
  const Aabb box = bounds_of(c[0], c[1], c[2]);
  if (box.extent().maxCoeff() > kFewVoxels) {
    // halved across its longest edge, so that of a needle no more pieces are made than it is long
    int longest = 0;
    const auto length = [&](int k) { return (c[(k + 1) % 3] - c[k]).squaredNorm(); };
    for (int k = 1; k < 3; ++k)
      if (length(k) > length(longest)) longest = k;
    const Vec3 &from = c[longest], &to = c[(longest + 1) % 3], &other = c[(longest + 2) % 3],
               middle = 0.5 * (from + to);
    mark(band, {from, middle, other}, poll);
    mark(band, {middle, to, other}, poll);
    return;
  }
  const VoxelIndex first = nearest_voxel(box.min - Vec3::Constant(kSlack)),
                   last = nearest_voxel(box.max + Vec3::Constant(kSlack));
  for (int i = first[0]; i <= last[0]; ++i)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int k = first[2]; k <= last[2]; ++k) {
        poll();
        const VoxelIndex voxel = {i, j, k};
        constexpr double kNear = kHalfDiagonal + kSlack;
        if (closest_on_triangle(center_of(voxel), c).squared_distance <= kNear * kNear) band.mark(voxel);
      }
}

}  // namespace

DistanceField::DistanceField(const SurfaceMesh& surface, std::size_t most_voxels) : most_voxels_(most_voxels) {
  const TriangleMesh& mesh = surface.mesh;
  for (const Triangle& t : mesh.triangles)
    bounds_.include(bounds_of(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  if (bounds_.is_empty()) return;
  origin_ = bounds_.center();
  // a mesh without area still has an extent
  const double area = std::max(area_of(mesh), 1e-6 * bounds_.extent().squaredNorm());
  size_ = std::max({0.25 * mean_edge_length(mesh), std::sqrt(kVoxelsAFace * area / static_cast<double>(most_voxels)),
                    1e-8 * bounds_.extent().maxCoeff()});
  while (!make_band(mesh)) size_ *= 1.2;
  take_distances(surface);
}

double DistanceField::reach() const { return (kLayers + 0.5) * size_; }

bool DistanceField::make_band(const TriangleMesh& mesh) {
  // a voxel that `kLayers` of neighbours don't reach is more layers away, along an axis, than that
  band_ = make_sparse_voxels(std::nextafter(static_cast<float>(reach()), 0.0f));
  InterruptPoll poll;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    TriangleCorners corners;
    for (int k = 0; k < 3; ++k) corners[k] = (mesh.vertices[mesh.triangles[i][k]] - origin_) / size_;
    mark(*band_, corners, poll);
    constexpr std::size_t kOften = 4096;  // triangles between two looks at how many voxels there are
    if (i % kOften == kOften - 1 && band_->count() > most_voxels_) return false;
  }
  band_->grow(kLayers);
  voxels_ = band_->count();
  return voxels_ <= most_voxels_;
}

void DistanceField::take_distances(const SurfaceMesh& surface) {
  const BoxTree& tree = surface.tree();
  parallel_for(band_->block_count(), 1, [&](std::size_t block) {
    InterruptPoll poll;
    NearestTriangle last;
    band_->fill(block, [&](const VoxelIndex& voxel) {
      poll();
      const Vec3 x = origin_ + size_ * center_of(voxel);
      last = nearest_triangle(tree, surface.mesh.triangles, surface.mesh.vertices, x, {}, last.triangle);
      return std::nextafter(static_cast<float>(std::sqrt(last.at.squared_distance)), 0.0f);
    });
  });
}

DistanceField::Reader::Reader(const DistanceField& field)
    : field_(field), values_(field.band_ ? field.band_->reader() : nullptr) {}

double DistanceField::Reader::at_least(const Vec3& x) {
  if (!values_) return std::numeric_limits<double>::infinity();
  const double outside = squared_distance(field_.bounds_, x);
  if (outside > 0.0) return std::sqrt(outside);
  const Vec3 in_voxels = (x - field_.origin_) / field_.size_;
  const VoxelIndex voxel = nearest_voxel(in_voxels);
  const double away = field_.size_ * (in_voxels - center_of(voxel)).norm();
  return std::max(0.0, static_cast<double>(values_->at(voxel)) - away);
}

std::shared_ptr<const DistanceField> SurfaceMesh::field(std::size_t most_voxels) const {
  return lazy_field.get([&](const DistanceField& field) { return field.most_voxels() == most_voxels; },
                        [&] { return std::make_shared<const DistanceField>(*this, most_voxels); });
}

}  // namespace impinge
#endif
