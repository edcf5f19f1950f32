// Other formats through assimp, in a child process. It only validates; polygons become triangles here and vertices welded
// by the caller, because its own steps for that crash on bad indices. Its coordinates are single precision.
#include <fmt/format.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>

#include "engine/io/meshes/import_in_child.hpp"
#include "engine/io/meshes/mesh_readers.hpp"
#include "engine/io/meshes/polygon.hpp"

namespace impinge {

namespace {

void append_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, TriangleMesh& mesh, int depth) {
  if (depth > 200) throw InputError("its nodes are nested deeper than 200");
  const aiMatrix4x4 transform = parent * node.mTransformation;
  const bool mirrored = transform.Determinant() < 0.0f;  // what was counter-clockwise seen from outside no longer is
  std::vector<int> corners;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
    const int first = static_cast<int>(mesh.vertices.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D x = transform * part.mVertices[v];
      if (!std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z))
        throw InputError(fmt::format("vertex {} is not finite", v));
      mesh.vertices.emplace_back(x.x, x.y, x.z);
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices < 3) continue;  // points and lines bound no solid
      corners.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= part.mNumVertices)
          throw InputError(fmt::format("face {} names vertex {} of {}", f, face.mIndices[k], part.mNumVertices));
        corners.push_back(first + static_cast<int>(face.mIndices[k]));
      }
      if (mirrored) std::reverse(corners.begin(), corners.end());
      append_polygon(corners, mesh.vertices, mesh.triangles);
    }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) append_node(scene, *node.mChildren[c], transform, mesh, depth + 1);
}

/// Files for assimp: a mesh file may name others (buffers, parts of a scene).
class GuardedFiles : public Assimp::DefaultIOSystem {
 public:
  explicit GuardedFiles(CompanionFiles& files) : files_(files) {}

  bool Exists(const char* file) const override { return files_.exists(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (!files_.may_open(file)) return nullptr;
    Assimp::IOStream* stream = DefaultIOSystem::Open(file, mode);
    files_.note(file, stream != nullptr);
    return stream;
  }

 private:
  CompanionFiles& files_;
};

/// Metres of a unit of the file. assimp converts Collada's <unit> by itself and hands FBX's over: centimetres, times a
/// factor. Other formats have none, or none that assimp reads (3MF: unit_of_3mf.cpp).
std::optional<double> unit_of(const aiScene& scene) {
  constexpr const char* kFactor = "UnitScaleFactor";
  float single = 0.0f;
  double factor = 0.0;
  if (scene.mMetaData == nullptr || !scene.mMetaData->HasKey(kFactor)) return std::nullopt;
  if (scene.mMetaData->Get(kFactor, single))
    factor = single;
  else if (!scene.mMetaData->Get(kFactor, factor))
    return std::nullopt;
  if (!std::isfinite(factor) || !(factor > 0.0)) throw InputError(fmt::format("its unit is {} cm", factor));
  return 0.01 * factor;
}

}  // namespace

Imported import_by_assimp(const std::string& path, CompanionFiles& files) {
  Assimp::Importer importer;
  importer.SetIOHandler(new GuardedFiles(files));  // the importer deletes it
  // two cameras or lights of one name make a file unsound to the importer, and are nothing to a surface
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_CAMERAS | aiComponent_LIGHTS);
  const aiScene* scene = importer.ReadFile(path, aiProcess_RemoveComponent);
  if (scene != nullptr) scene = importer.ApplyPostProcessing(aiProcess_ValidateDataStructure);
  files.throw_refusal();
  if (scene == nullptr || scene->mRootNode == nullptr) {
    files.throw_missing();
    throw InputError(importer.GetErrorString());
  }
  Imported out;
  append_node(*scene, *scene->mRootNode, aiMatrix4x4(), out.mesh, 0);
  out.unit = ending(path) == ".3mf" ? metres_of_3mf(path) : unit_of(*scene);
  if (out.unit)
    for (Vec3& x : out.mesh.vertices) x *= *out.unit;
  out.opened = files.opened();
  return out;
}

TriangleMesh read_with_assimp(const std::filesystem::path& path, const FileGuard& guard, MeshOrigin& origin) {
  const std::string name = path.string();
  {
    const Assimp::Importer importer;
    if (const std::string kind = ending(name); kind == ".msh" || kind == ".veg")
      throw InputError(
          fmt::format("{}: tetrahedra, and not a surface; ply, off, obj, stl and what assimp reads are "
                      "surfaces; it is the volume of a deformable body: volume = \"{}\"",
                      name, path.filename().string()));
    if (!importer.IsExtensionSupported(path.extension().string()))
      throw InputError(
          fmt::format("{}: the ending '{}' is no known mesh format; ply, off, obj, stl and what assimp reads are; "
                      "convert it to PLY",
                      name, path.extension().string()));
  }
  TriangleMesh mesh = import_in_child(path, guard, import_by_assimp, origin);
  if (origin.unit.empty() && ending(name) == ".dae") origin.unit = "as its <unit> says";  // which assimp has converted
  return mesh;
}

}  // namespace impinge
