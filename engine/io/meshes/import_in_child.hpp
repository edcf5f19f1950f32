// Importers that others wrote, in a process of their own: they abort or crash on some damaged files, and nothing of that
// may reach the caller.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/io/file_guard.hpp"
#include "engine/io/meshes/mesh_file.hpp"

namespace impinge {

/// What an importer read of a file.
struct Imported {
  TriangleMesh mesh;                ///< in metres, where the format has a unit
  std::optional<double> unit;       ///< metres of the unit that the file itself says
  std::vector<std::string> opened;  ///< files, the mesh file among them, some more than once
};

/// A file that the mesh file names and that must not be read; worded to follow the file's name.
struct RefusedCompanion : InputError {
  using InputError::InputError;
};
/// A file that the mesh file names and that can't be opened: its name.
struct MissingCompanion : InputError {
  using InputError::InputError;
};

/// Files that one mesh file names, as its importer asks for them.
class CompanionFiles {
 public:
  explicit CompanionFiles(const FileGuard& guard) : guard_(guard) {}

  /// Whether it is allowed and there. Importers may ask for files that nobody names.
  bool exists(const std::string& file) const;
  /// Whether it may be opened now; a refusal is kept.
  bool may_open(const std::string& file);
  /// What came of opening one that may be.
  void note(const std::string& file, bool opened);
  /// Keeps a file as one that can't be opened, unless another one is kept.
  void note_missing(const std::string& file);

  const std::vector<std::string>& opened() const { return opened_; }
  /// Throws RefusedCompanion after a refusal.
  void throw_refusal() const;
  /// Throws MissingCompanion if one could not be opened. Importers may get on without it.
  void throw_missing() const;

 private:
  const FileGuard& guard_;
  std::vector<std::string> opened_;
  std::string refusal_, missing_;
};

/// Reads `path` by `import` in a child process; `origin` gets what it found out. Throws InputError, with the file's name
/// in front, for what the importer throws, and if it crashes.
TriangleMesh import_in_child(const std::filesystem::path& path, const FileGuard& guard,
                             const std::function<Imported(const std::string&, CompanionFiles&)>& import,
                             MeshOrigin& origin);

}  // namespace impinge
