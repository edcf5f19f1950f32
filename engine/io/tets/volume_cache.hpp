// Volumes made at load time, kept by content: nothing is meshed twice.
//
// A key is made of everything the result depends on: the surface's vertices and triangles, the options, a version.
// Within a program results are shared; between programs they lie as files in a folder, which may be removed at any
// time.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "engine/geometry/tets/embedding.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Tetrahedra that carry a surface.
struct CarriedVolume {
  TetMesh mesh;                  ///< in the surface's coordinates, metres
  std::vector<double> fraction;  ///< filled fraction of each tetrahedron; empty: all full
  Embedding embedding;           ///< of the surface's vertices
};
using VolumePointer = std::shared_ptr<const CarriedVolume>;

/// What IMPINGE_CACHE names; else $XDG_CACHE_HOME/impinge; else ~/.cache/impinge. Empty: no folder is used
/// (IMPINGE_CACHE=off, or none of these is set).
std::filesystem::path cache_folder();

class VolumeCache {
 public:
  explicit VolumeCache(std::filesystem::path folder = cache_folder()) : folder_(std::move(folder)) {}

  /// The volume of this surface by these options ("cage 12", ...), made if it isn't there. A damaged file is replaced;
  /// a folder that can't be read or written is left alone.
  VolumePointer get(const TriangleMesh& surface, const std::string& options,
                    const std::function<CarriedVolume()>& make);

  int made() const { return made_; }  ///< how many were made, not found

 private:
  std::filesystem::path folder_;
  std::map<std::string, VolumePointer> known_;  // by key
  int made_ = 0;
};

}  // namespace impinge
