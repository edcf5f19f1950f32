#ifdef IMPINGE_OPENVDB
#include "engine/geometry/sparse_voxels.hpp"

#include <dlfcn.h>

#include <filesystem>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

using Make = SparseVoxels*(float);

/// The library's one function. It stays loaded.
Make* load() {
  constexpr const char* kName = "libimpinge_openvdb.so";
  std::error_code none;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  for (const std::filesystem::path& folder : {program, program.parent_path()}) {
    void* library = dlopen((folder / kName).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) continue;
    if (void* found = dlsym(library, "impinge_make_sparse_voxels")) return reinterpret_cast<Make*>(found);
  }
  const char* why = dlerror();
  throw InputError(std::string("distance fields need ") + kName +
                   ", which is built beside the program: " + (why != nullptr ? why : "it has no such function"));
}

}  // namespace

std::unique_ptr<SparseVoxels> make_sparse_voxels(float background) {
  static Make* const make = load();
  return std::unique_ptr<SparseVoxels>(make(background));
}

}  // namespace impinge
#endif
