// Other formats through assimp, in a child process: assimp aborts or crashes on some damaged files, and nothing of that
// may reach the caller. It only validates; polygons become triangles here and vertices welded by the caller, because its own
// steps for that crash on bad indices. Its coordinates are single precision.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <csignal>

#include "engine/core/archive.hpp"
#include "engine/io/child_process.hpp"
#include "engine/io/companion_error.hpp"
#include "engine/io/meshes/mesh_readers.hpp"
#include "engine/io/meshes/polygon.hpp"

namespace impinge {

namespace {

void append_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, TriangleMesh& mesh, int depth) {
  if (depth > 200) throw InputError("its nodes are nested deeper than 200");
  const aiMatrix4x4 transform = parent * node.mTransformation;
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
      append_polygon(corners, mesh.vertices, mesh.triangles);
    }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) append_node(scene, *node.mChildren[c], transform, mesh, depth + 1);
}

/// Files for assimp: a mesh file may name others (buffers, parts of a scene), which must lie where the guard allows
/// it.
class GuardedFiles : public Assimp::DefaultIOSystem {
 public:
  explicit GuardedFiles(const FileGuard& guard) : guard_(guard) {}

  // importers look whether files are there that nobody names: those are just not there
  bool Exists(const char* file) const override { return !guard_.refused(file) && DefaultIOSystem::Exists(file); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (const auto target = guard_.refused(file))
      return refuse(fmt::format("names '{}', which leads out of the scene's folder ({})", file, target->string()));
    // the file itself is one
    if (std::ssize(opened_) > kMostIncludes) return refuse(fmt::format("names more than {} files", kMostIncludes));
    Assimp::IOStream* stream = DefaultIOSystem::Open(file, mode);
    if (stream != nullptr)
      opened_.emplace_back(file);
    else if (missing_.empty())
      missing_ = file;
    return stream;
  }
  /// The first refusal, worded to follow the file's name; "" where there was none.
  const std::string& problem() const { return problem_; }
  /// The first that could not be opened, "" where there was none. Importers may get on without it.
  const std::string& missing() const { return missing_; }
  /// In the order in which they were opened, the mesh file among them; some more than once.
  const std::vector<std::string>& opened() const { return opened_; }

 private:
  Assimp::IOStream* refuse(const std::string& problem) {
    if (problem_.empty()) problem_ = problem;
    return nullptr;
  }

  const FileGuard& guard_;
  std::vector<std::string> opened_;
  std::string problem_, missing_;
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

// what the child sends: 'M' and the mesh, 'E' and why not, 'N' and a file that it needs and that can't be opened, or 'R'
// and what it asked for that it must not have
std::string import_in_child(const std::string& path, const FileGuard& guard) {
  auto* files = new GuardedFiles(guard);  // the importer deletes it
  Assimp::Importer importer;
  importer.SetIOHandler(files);
  try {
    // two cameras or lights of one name make a file unsound to the importer, and are nothing to a surface
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_CAMERAS | aiComponent_LIGHTS);
    const aiScene* scene = importer.ReadFile(path, aiProcess_RemoveComponent);
    if (scene != nullptr) scene = importer.ApplyPostProcessing(aiProcess_ValidateDataStructure);
    if (!files->problem().empty()) return "R" + files->problem();
    const bool failed = scene == nullptr || scene->mRootNode == nullptr;
    if (failed && !files->missing().empty()) return "N" + files->missing();
    if (failed) return std::string("E") + importer.GetErrorString();
    TriangleMesh mesh;
    append_node(*scene, *scene->mRootNode, aiMatrix4x4(), mesh, 0);
    const std::optional<double> unit = ending(path) == ".3mf" ? metres_of_3mf(path) : unit_of(*scene);
    if (unit)
      for (Vec3& x : mesh.vertices) x *= *unit;
    ByteWriter out;
    out.put('M');
    out.put<double>(unit.value_or(0.0));
    out.put<std::uint64_t>(mesh.vertices.size());
    out.put<std::uint64_t>(mesh.triangles.size());
    for (const Vec3& x : mesh.vertices) out.put(x);
    for (const Triangle& t : mesh.triangles)
      for (const int v : t) out.put(v);
    for (const std::string& file : files->opened()) {
      out.put<std::uint64_t>(file.size());
      out.put_bytes(file.data(), file.size());
    }
    return out.bytes();
  } catch (const std::exception& error) {
    return std::string("E") + error.what();
  }
}

void limit_resources() {
  const rlimit no_core{0, 0}, seconds{120, 120};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &seconds);
#ifndef __SANITIZE_ADDRESS__
  const rlimit memory{rlim_t{8} << 30, rlim_t{8} << 30};
  setrlimit(RLIMIT_AS, &memory);
#endif
}

[[noreturn]] void child(const std::string& path, const FileGuard& guard, int out) {
  limit_resources();
  sigset_t none;  // what the parent blocks, to take care of it by itself, ends this one
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  // not by the streams: they would first write what the parent has put into them and will write itself
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere < 0 || dup2(nowhere, STDOUT_FILENO) < 0 || dup2(nowhere, STDERR_FILENO) < 0) _exit(1);
  const std::string bytes = import_in_child(path, guard);
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ssize_t n = write(out, rest.data(), rest.size());
    if (n <= 0) _exit(1);
    rest.remove_prefix(static_cast<std::size_t>(n));
  }
  _exit(0);
}

}  // namespace

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
  int ends[2];
  if (pipe(ends) != 0)
    throw InputError(name + ": no pipe to the importer; the system is out of file handles; close some programs");
  const pid_t pid = fork();
  if (pid < 0)
    throw InputError(name + ": no process for the importer; the system is out of processes; close some programs");
  if (pid == 0) {
    close(ends[0]);
    child(name, guard, ends[1]);
  }
  close(ends[1]);
  ChildProcess importer(pid);
  const std::string bytes = ChildProcess::read_all(ends[0]);
  const int status = importer.wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || bytes.empty())
    throw InputError(name + ": the importer failed on it; a sound file is wanted; convert it to PLY");
  if (bytes[0] == 'R')
    throw CompanionError(
        name, fmt::format("{}; files inside it are read, {} at most; copy them there, or convert the mesh to PLY",
                          bytes.substr(1), kMostIncludes));
  if (bytes[0] == 'N')
    throw CompanionError(
        name, fmt::format("names '{}', which can't be opened; a mesh with all files that it names is wanted; "
                          "put it there, or convert the mesh to PLY",
                          bytes.substr(1)));
  if (bytes[0] == 'E')
    throw InputError(
        fmt::format("{}: can't be read ({}); a sound file is wanted; convert it to PLY", name, bytes.substr(1)));

  ByteReader in(bytes);
  in.get<char>();
  const auto metres = in.get<double>();
  const std::string format = ending(name);
  if (metres > 0.0)
    origin.unit = fmt::format("{:.6g} m, as it says", metres);
  else if (format == ".dae")
    origin.unit = "as its <unit> says";  // which assimp has converted
  else if (format == ".gltf" || format == ".glb")
    origin.unit = "metres, as the format has it";
  TriangleMesh mesh;
  const auto vertices = in.get<std::uint64_t>(), triangles = in.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < vertices; ++i) mesh.vertices.push_back(in.get_vec3());
  for (std::uint64_t i = 0; i < triangles; ++i) {
    const int a = in.get<int>(), b = in.get<int>(), c = in.get<int>();
    mesh.triangles.push_back({a, b, c});
  }
  while (!in.at_end()) {
    std::string file(in.get<std::uint64_t>(), '\0');
    for (char& c : file) c = in.get<char>();
    if (file != name && std::find(origin.others.begin(), origin.others.end(), file) == origin.others.end())
      origin.others.emplace_back(file);
  }
  return mesh;
}

}  // namespace impinge
