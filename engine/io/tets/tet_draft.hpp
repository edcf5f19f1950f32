// What the readers of volume meshes share: a mesh whose parts know the line they come from, and the checks that make it
// a body.
#pragma once

#include "engine/io/tets/tet_file.hpp"

namespace impinge {

struct FilePlace {
  int file = 0, line = 0, column = 1;
};

struct TetDraft {
  std::vector<std::string> files;  ///< names for messages
  TetFile result;
  std::vector<FilePlace> vertex_place, tet_place;
  std::vector<long long> vertex_label, tet_label;  ///< what the file calls them

  /// Throws InputError `file:line:column: found; allowed; remedy`.
  [[noreturn]] void fail(const FilePlace& at, const std::string& found, const std::string& allowed,
                         const std::string& remedy) const;
};

/// Checks the draft and hands its mesh over. Vertices in no tetrahedron are dropped with a note, or refused.
TetFile finish_tets(TetDraft draft, bool drop_unused);

/// Most vertices or tetrahedra that are taken.
inline constexpr long long kMostTets = 50'000'000;
/// Largest volume mesh file, bytes.
inline constexpr std::uint64_t kLargestTetFile = 4'000'000'000;

}  // namespace impinge
