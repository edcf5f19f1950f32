// Voxels of a sparse grid, each with a number [Museth13]. OpenVDB holds them, in a library of its own that is loaded when the
// first grid is made: it would add 30 ms to the start of every program that has none.
#pragma once

#include <array>
#include <functional>
#include <memory>

namespace impinge {

using VoxelIndex = std::array<int, 3>;

class SparseVoxels {
 public:
  /// Looks numbers up; remembers where the last one was, so each thread has its own.
  class Reader {
   public:
    virtual ~Reader() = default;
    /// The background where there is no voxel.
    virtual float at(const VoxelIndex& voxel) = 0;
  };

  virtual ~SparseVoxels() = default;
  virtual void mark(const VoxelIndex& voxel) = 0;
  /// Adds all neighbours, those at corners too, `layers` times.
  virtual void grow(int layers) = 0;
  virtual std::size_t count() const = 0;
  /// The voxels are in blocks, which different threads may fill; none may be added after this.
  virtual std::size_t block_count() = 0;
  virtual void fill(std::size_t block, const std::function<float(const VoxelIndex&)>& value_at) = 0;
  virtual std::unique_ptr<Reader> reader() const = 0;
};

/// Without a voxel. Throws InputError (without a place) if the library isn't beside the program.
std::unique_ptr<SparseVoxels> make_sparse_voxels(float background);

}  // namespace impinge
