// What a body says of its surface file beside its name: unit, axes, which part, and how it is mended.
#pragma once

#include <optional>

#include "engine/geometry/mend/mend.hpp"
#include "engine/io/scene/toml.hpp"

namespace impinge {

struct SurfaceKeys {
  double metres = 1.0;  ///< of the unit that the file's numbers are in
  bool is_unit_given = false;
  bool z_up = false;  ///< the file's z is the scene's y, its −y the scene's z
  Vec3 scale = Vec3::Ones();
  std::optional<int> component;  ///< this connected part alone, from 1
  std::optional<MendSettings> mend;
  bool convex = false;          ///< its hull is the shape
  std::optional<int> decimate;  ///< what takes part in contact has so many triangles at most

  /// Of the surface that a decimated one stands for.
  SurfaceKeys full() const;

  /// One scale and nothing else.
  bool is_plain() const;
  /// Two bodies with the same text have the same surface.
  std::string text() const;
};

/// Of the table of a body. Throws InputError, located, at the first value that can't be taken.
SurfaceKeys read_surface_keys(const TomlNode& table, const std::string& what);

/// The keys that read_surface_keys() reads, without `scale`: of a surface only.
const std::vector<std::string>& surface_keys();

/// Unit, axes, scale and part; `mend` is not done. Throws InputError where there is no such part, located at its key.
TriangleMesh placed(TriangleMesh mesh, const SurfaceKeys& keys, const TomlNode& table, const std::string& what);

}  // namespace impinge
