#include "engine/io/tets/tet_file.hpp"

#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/io/companion_error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/tets/tet_draft.hpp"

namespace impinge {

TetFile read_tet_file(const std::filesystem::path& path, const FileGuard& guard) {
  const std::string ending = path.extension().string();
  if (ending == ".veg") return parse_veg(path.string(), read_file(path, kLargestTetFile), path.parent_path(), guard);
  if (ending == ".msh") return parse_msh(path.string(), read_file(path, kLargestTetFile));
  if (ending == ".node" || ending == ".ele") {
    const std::filesystem::path node = std::filesystem::path(path).replace_extension(".node"),
                                ele = std::filesystem::path(path).replace_extension(".ele");
    for (const auto& part : {node, ele})
      if (const auto target = guard.refused(part))
        throw CompanionError(
            path, fmt::format("'{}' leads out of the scene's folder ({}); files inside it are read; put both into one "
                              "folder",
                              part.string(), target->string()));
    for (const auto& part : {node, ele})
      if (!is_there(part))
        throw CompanionError(
            path, fmt::format("'{}' is not there; a TetGen mesh is a .node and an .ele file of the same name; "
                              "put both into one folder",
                              part.string()));
    const std::string node_bytes = read_file(node, kLargestTetFile), ele_bytes = read_file(ele, kLargestTetFile);
    return parse_tetgen(node.string(), node_bytes, ele.string(), ele_bytes);
  }
  throw InputError(
      fmt::format("{}: the ending '{}' is no volume mesh format; .veg, .node/.ele and .msh are read; convert the file",
                  path.string(), ending));
}

}  // namespace impinge
