// The one file that OpenVDB's headers are in; its library is loaded by geometry/sparse_voxels.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tree/LeafManager.h>

#include "engine/geometry/sparse_voxels.hpp"

namespace impinge {
namespace {

openvdb::Coord coord_of(const VoxelIndex& voxel) { return {voxel[0], voxel[1], voxel[2]}; }

class OpenvdbVoxels final : public SparseVoxels {
 public:
  explicit OpenvdbVoxels(float background) : tree_(background), marking_(tree_) {}

  void mark(const VoxelIndex& voxel) override { marking_.setValueOn(coord_of(voxel), 0.0f); }
  void grow(int layers) override {
    marking_.clear();
    openvdb::tools::dilateActiveValues(tree_, layers, openvdb::tools::NN_FACE_EDGE_VERTEX, openvdb::tools::EXPAND_TILES,
                                       false);
  }
  std::size_t count() const override { return tree_.activeVoxelCount(); }
  std::size_t block_count() override {
    if (!leaves_) leaves_ = std::make_unique<Leaves>(tree_);
    return leaves_->leafCount();
  }
  void fill(std::size_t block, const std::function<float(const VoxelIndex&)>& value_at) override {
    for (auto voxel = leaves_->leaf(block).beginValueOn(); voxel; ++voxel) {
      const openvdb::Coord at = voxel.getCoord();
      voxel.setValue(value_at({at.x(), at.y(), at.z()}));
    }
  }
  std::unique_ptr<Reader> reader() const override { return std::make_unique<TreeReader>(tree_); }

 private:
  using Leaves = openvdb::tree::LeafManager<openvdb::FloatTree>;
  class TreeReader final : public Reader {
   public:
    explicit TreeReader(const openvdb::FloatTree& tree) : accessor_(tree) {}
    float at(const VoxelIndex& voxel) override { return accessor_.getValue(coord_of(voxel)); }

   private:
    openvdb::tree::ValueAccessor<const openvdb::FloatTree> accessor_;
  };

  openvdb::FloatTree tree_;
  openvdb::tree::ValueAccessor<openvdb::FloatTree> marking_;
  std::unique_ptr<Leaves> leaves_;
};

}  // namespace
}  // namespace impinge

extern "C" impinge::SparseVoxels* impinge_make_sparse_voxels(float background) {
  return new impinge::OpenvdbVoxels(background);
}
