// glTF and GLB [Khronos21] through tinygltf, which knows the document and its buffers; what surface they make is found here.
// assimp takes integers for single precision and leaves out instances, whatever the file says that a reader must know. It
// still reads what it alone can: meshes packed by Draco, and glTF 1.
#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/io/file.hpp"
#include "engine/io/meshes/gltf_accessor.hpp"
#include "engine/io/meshes/import_in_child.hpp"
#include "engine/io/meshes/mesh_readers.hpp"

namespace impinge {
namespace {

using Mat4 = Eigen::Matrix4d;

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kInstances = "EXT_mesh_gpu_instancing";

/// Whether a reader who knows nothing of the extension but its name gets the right surface.
bool is_understood(std::string_view extension) {
  // integers as coordinates: gltf_accessor reads them
  for (const std::string_view known : {"KHR_mesh_quantization", kInstances, "KHR_lights_punctual", "KHR_xmp_json_ld",
                                       "KHR_texture_transform", "KHR_texture_basisu", "MSFT_texture_dds"})
    if (extension == known) return true;
  // what it looks like
  for (const std::string_view family :
       {"KHR_materials_", "EXT_materials_", "ADOBE_materials_", "EXT_texture_", "EXT_lights_"})
    if (extension.starts_with(family)) return true;
  return false;
}

void refuse_unknown(const std::vector<std::string>& extensions) {
  for (const std::string& name : extensions)
    if (!is_understood(name))
      throw InputError(fmt::format("it needs the extension {}, which is not read", name.substr(0, 80)));
}

bool is_packed(const tinygltf::Model& model) {
  const std::vector<std::string>& used = model.extensionsUsed;
  return std::find(used.begin(), used.end(), kDraco) != used.end();
}

/// Pictures are nothing to a surface, and must not be read, asked for or missed.
bool is_picture(const std::string& file) {
  const std::string end = ending(file);
  const auto kinds = {".png", ".jpg", ".jpeg", ".webp", ".ktx", ".ktx2", ".basis", ".dds", ".bmp", ".tga", ".gif"};
  return std::any_of(kinds.begin(), kinds.end(), [&](const char* kind) { return end == kind; });
}

/// The loader's way to files.
struct LoaderFiles {
  CompanionFiles& companions;
  std::string folder;  ///< of the mesh file, "" or with a slash at its end
};

bool file_exists(const std::string& file, void* data) {
  const LoaderFiles& files = *static_cast<LoaderFiles*>(data);
  // what it doesn't find in the mesh's folder it looks for in the present one
  if (!file.starts_with(files.folder) || is_picture(file) || !files.companions.may_open(file)) return false;
  const bool there = files.companions.exists(file);
  if (!there) files.companions.note_missing(file);
  return there;
}

std::string same_path(const std::string& path, void*) { return path; }

bool read_whole(std::vector<unsigned char>* out, std::string* problem, const std::string& file, void* data) {
  CompanionFiles& companions = static_cast<LoaderFiles*>(data)->companions;
  try {
    const std::string bytes = read_file(file, kMostMeshBytes);
    out->assign(bytes.begin(), bytes.end());
    companions.note(file, true);
    return true;
  } catch (const InputError& error) {
    *problem = error.what();
    companions.note(file, false);
    return false;
  }
}

bool no_picture(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

/// Several lines of problems as one.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;) text.replace(at, 1, "; ");
  return text.empty() ? "no reason given" : text;
}

tinygltf::Model load(const std::string& path, CompanionFiles& files) {
  const std::string bytes = read_file(path, kMostMeshBytes);
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) throw InputError("it has more than 4 GiB");
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(no_picture, nullptr);
  LoaderFiles way{files, std::filesystem::path(path).parent_path().string()};
  if (!way.folder.empty() && !way.folder.ends_with('/')) way.folder += '/';
  loader.SetFsCallbacks({file_exists, same_path, read_whole, nullptr, &way});
  tinygltf::Model model;
  std::string problem, doubt;
  const auto size = static_cast<unsigned>(bytes.size());
  const bool read =
      bytes.starts_with("glTF")
          ? loader.LoadBinaryFromMemory(&model, &problem, &doubt, reinterpret_cast<const unsigned char*>(bytes.data()),
                                        size, way.folder)
          : loader.LoadASCIIFromString(&model, &problem, &doubt, bytes.data(), size, way.folder);
  files.throw_refusal();
  if (read || is_packed(model)) return model;
  refuse_unknown(model.extensionsUsed);  // a packed file has buffers that nobody else can read
  files.throw_missing();
  throw InputError(one_line(problem));
}

Mat4 transform_of(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return Eigen::Map<const Mat4>(node.matrix.data());
  Eigen::Affine3d out = Eigen::Affine3d::Identity();
  if (const auto& t = node.translation; t.size() == 3) out.translate(Vec3(t[0], t[1], t[2]));
  if (const auto& q = node.rotation; q.size() == 4) out.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
  if (const auto& s = node.scale; s.size() == 3) out.scale(Vec3(s[0], s[1], s[2]));
  return out.matrix();
}

/// Where the node's mesh stands, relative to the node: at its own place once, or at each of its instances.
std::vector<Mat4> instances_of(const tinygltf::Model& model, const tinygltf::Node& node) {
  const auto extension = node.extensions.find(kInstances);
  if (extension == node.extensions.end()) return {Mat4::Identity()};
  if (!extension->second.Has("attributes")) throw InputError("instances without attributes");
  const tinygltf::Value& attributes = extension->second.Get("attributes");
  std::optional<std::size_t> count;
  const auto numbers = [&](const char* name, int components) -> std::vector<double> {
    if (!attributes.Has(name)) return {};
    std::vector<double> out = gltf_numbers(model, attributes.Get(name).GetNumberAsInt(), components);
    const std::size_t n = out.size() / static_cast<std::size_t>(components);
    if (count.value_or(n) != n) throw InputError("instances whose attributes differ in number");
    count = n;
    return out;
  };
  const auto translations = numbers("TRANSLATION", 3), rotations = numbers("ROTATION", 4), scales = numbers("SCALE", 3);
  std::vector<Mat4> out;
  tinygltf::Node one;
  for (std::size_t i = 0; i < count.value_or(0); ++i) {
    const auto part = [&](const std::vector<double>& of, std::size_t n) {
      const auto at = of.begin() + static_cast<std::ptrdiff_t>(n * i);
      return of.empty() ? std::vector<double>() : std::vector<double>(at, at + static_cast<std::ptrdiff_t>(n));
    };
    one.translation = part(translations, 3);
    one.rotation = part(rotations, 4);
    one.scale = part(scales, 3);
    out.push_back(transform_of(one));
  }
  return out;
}

/// A surface of the document, in its own frame: the vertices that its triangles use, in the accessor's order.
TriangleMesh surface_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  const auto position = primitive.attributes.find("POSITION");
  if (mode < TINYGLTF_MODE_TRIANGLES || position == primitive.attributes.end())
    return {};  // points and lines bound no solid
  if (mode > TINYGLTF_MODE_TRIANGLE_FAN) throw InputError(fmt::format("a mesh of mode {}", mode));
  const std::vector<double> x = gltf_numbers(model, position->second, 3);
  const auto vertices = static_cast<std::uint32_t>(x.size() / 3);
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = gltf_indices(model, primitive.indices);
  } else {
    for (std::uint32_t v = 0; v < vertices; ++v) indices.push_back(v);
  }
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] >= vertices)
      throw InputError(fmt::format("index {} of a mesh names vertex {} of {}", i, indices[i], vertices));
  if (mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0)
    throw InputError(fmt::format("a mesh of triangles has {} indices", indices.size()));

  TriangleMesh out;
  std::vector<int> number(vertices, -1);
  for (const std::uint32_t v : indices) number[v] = 0;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(out.vertices.size());
    out.vertices.emplace_back(x[3 * v], x[3 * v + 1], x[3 * v + 2]);
  }
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    out.triangles.push_back({number[indices[a]], number[indices[b]], number[indices[c]]});
  };
  if (mode == TINYGLTF_MODE_TRIANGLES)
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) add(i, i + 1, i + 2);
  else
    for (std::size_t i = 0; i + 2 < indices.size(); ++i)
      if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
        add(i, i + 1 + i % 2, i + 2 - i % 2);  // every other one runs the other way
      else
        add(i + 1, i + 2, 0);
  return out;
}

void append(const TriangleMesh& part, const Mat4& transform, TriangleMesh& mesh) {
  if (std::ssize(mesh.vertices) + std::ssize(part.vertices) > kMostElements)
    throw InputError(fmt::format("it has more than {} vertices", kMostElements));
  const int first = static_cast<int>(mesh.vertices.size());
  for (const Vec3& x : part.vertices) {
    const Vec3 placed = (transform * x.homogeneous()).head<3>();
    if (!placed.allFinite()) throw InputError(fmt::format("vertex {} is not finite", &x - part.vertices.data()));
    mesh.vertices.push_back(placed);
  }
  // what was counter-clockwise seen from outside no longer is, in a mirror
  const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0.0;
  for (Triangle t : part.triangles) {
    if (mirrored) std::swap(t[1], t[2]);
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

void append_gltf_node(const tinygltf::Model& model, int number, const Mat4& parent, std::vector<char>& seen,
                      TriangleMesh& mesh, int depth) {
  const tinygltf::Node& node = gltf_element(model.nodes, number, "node");
  if (depth > 200) throw InputError("its nodes are nested deeper than 200");
  if (std::exchange(seen[static_cast<std::size_t>(number)], 1) != 0)
    throw InputError(fmt::format("node {} hangs at two places", number));
  const Mat4 transform = parent * transform_of(node);
  if (node.mesh >= 0)
    for (const tinygltf::Primitive& primitive : gltf_element(model.meshes, node.mesh, "mesh").primitives) {
      const TriangleMesh part = surface_of(model, primitive);
      for (const Mat4& instance : instances_of(model, node)) append(part, transform * instance, mesh);
    }
  for (const int child : node.children) append_gltf_node(model, child, transform, seen, mesh, depth + 1);
}

/// The nodes that the scene to show begins with; all that hang at no other where the document has no scene.
std::vector<int> roots_of(const tinygltf::Model& model) {
  if (!model.scenes.empty()) return gltf_element(model.scenes, std::max(model.defaultScene, 0), "scene").nodes;
  std::vector<char> child(model.nodes.size(), 0);
  for (const tinygltf::Node& node : model.nodes)
    for (const int c : node.children) {
      gltf_element(model.nodes, c, "node");
      child[static_cast<std::size_t>(c)] = 1;
    }
  std::vector<int> roots;
  for (std::size_t n = 0; n < child.size(); ++n)
    if (child[n] == 0) roots.push_back(static_cast<int>(n));
  return roots;
}

Imported import_gltf(const std::string& path, CompanionFiles& files) {
  files.note(path, true);
  const tinygltf::Model model = load(path, files);
  if (model.asset.version.starts_with("1.") || is_packed(model)) return import_by_assimp(path, files);
  refuse_unknown(model.extensionsRequired);
  Imported out;
  std::vector<char> seen(model.nodes.size(), 0);
  for (const int root : roots_of(model)) append_gltf_node(model, root, Mat4::Identity(), seen, out.mesh, 0);
  out.opened = files.opened();
  return out;
}

}  // namespace

TriangleMesh read_gltf(const std::filesystem::path& path, const FileGuard& guard, MeshOrigin& origin) {
  TriangleMesh mesh = import_in_child(path, guard, import_gltf, origin);
  origin.unit = "metres, as the format has it";
  return mesh;
}

}  // namespace impinge
