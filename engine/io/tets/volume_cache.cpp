#include "engine/io/tets/volume_cache.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/io/file.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

// to be raised when the same surface and options would give another volume, or the file's layout changes
constexpr const char* kVersion = "impinge volume 1";
constexpr std::uint64_t kLargestFile = std::uint64_t{4} << 30;

std::string key_of(const TriangleMesh& surface, const std::string& options) {
  ByteWriter out;
  for (const Vec3& v : surface.vertices) out.put(v);
  for (const Triangle& t : surface.triangles)
    for (const int v : t) out.put(v);
  const std::string head =
      fmt::format("{}\n{}\n{} {}\n", kVersion, options, surface.vertices.size(), surface.triangles.size());
  // two hashes of different seeds: 128 bits, so that no two volumes ever meet by chance
  return hex64(hash_bytes(out.bytes(), hash_bytes(head, 1))) + hex64(hash_bytes(out.bytes(), hash_bytes(head, 2)));
}

std::string to_bytes(const CarriedVolume& volume) {
  ByteWriter out;
  const auto size = [&](std::size_t n) { out.put(static_cast<std::uint64_t>(n)); };
  size(volume.mesh.vertices.size());
  for (const Vec3& v : volume.mesh.vertices) out.put(v);
  size(volume.mesh.tets.size());
  for (const Tet& t : volume.mesh.tets)
    for (const int v : t) out.put(v);
  size(volume.fraction.size());
  for (const double f : volume.fraction) out.put(f);
  size(volume.embedding.tet.size());
  for (const int t : volume.embedding.tet) out.put(t);
  for (const Vec4& w : volume.embedding.weight)
    for (int k = 0; k < 4; ++k) out.put(w[k]);
  out.put(volume.embedding.outside);
  out.put(volume.embedding.farthest);
  return out.bytes();
}

// the bytes' hash has been compared: they are what to_bytes wrote
CarriedVolume from_bytes(std::string_view bytes) {
  ByteReader in(bytes);
  CarriedVolume volume;
  const auto size = [&] { return static_cast<std::size_t>(in.get<std::uint64_t>()); };
  volume.mesh.vertices.resize(size());
  for (Vec3& v : volume.mesh.vertices) v = in.get_vec3();
  volume.mesh.tets.resize(size());
  for (Tet& t : volume.mesh.tets)
    for (int& v : t) v = in.get<int>();
  volume.fraction.resize(size());
  for (double& f : volume.fraction) f = in.get<double>();
  volume.embedding.tet.resize(size());
  volume.embedding.weight.resize(volume.embedding.tet.size());
  for (int& t : volume.embedding.tet) t = in.get<int>();
  for (Vec4& w : volume.embedding.weight)
    for (int k = 0; k < 4; ++k) w[k] = in.get<double>();
  volume.embedding.outside = in.get<int>();
  volume.embedding.farthest = in.get<double>();
  return volume;
}

std::string head_of(const std::string& key, std::string_view body) {
  return fmt::format("{}\n{}\n{}\n", kVersion, key, hex64(hash_bytes(body)));
}

VolumePointer load(const fs::path& path, const std::string& key) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return nullptr;
  try {
    const std::string bytes = read_file(path, kLargestFile);
    const std::size_t head = head_of(key, {}).size();  // of the same length for any body
    if (bytes.size() < head) return nullptr;
    const std::string_view body = std::string_view(bytes).substr(head);
    if (bytes.compare(0, head, head_of(key, body)) != 0) return nullptr;
    return std::make_shared<CarriedVolume>(from_bytes(body));
  } catch (const InputError&) {
    return nullptr;
  }
}

void save(const fs::path& path, const std::string& key, const CarriedVolume& volume) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) return;
  try {
    const std::string body = to_bytes(volume);
    // two programs may write the same volume at once: each into a file of its own, the last rename stays
    write_file(path, head_of(key, body) + body);
  } catch (const InputError&) {  // a full or read-only disk: the volume is there all the same
  }
}

}  // namespace

fs::path cache_folder() {
  const auto value = [](const char* name) {
    const char* text = std::getenv(name);
    return std::string(text == nullptr ? "" : text);
  };
  if (const std::string own = value("IMPINGE_CACHE"); !own.empty()) return own == "off" ? fs::path() : fs::path(own);
  // a relative XDG_CACHE_HOME is to be ignored (XDG base directory specification)
  if (const fs::path xdg = value("XDG_CACHE_HOME"); xdg.is_absolute()) return xdg / "impinge";
  if (const fs::path home = value("HOME"); home.is_absolute()) return home / ".cache" / "impinge";
  return {};
}

VolumePointer VolumeCache::get(const TriangleMesh& surface, const std::string& options,
                               const std::function<CarriedVolume()>& make) {
  const std::string key = key_of(surface, options);
  VolumePointer& known = known_[key];
  if (known != nullptr) return known;
  const fs::path path = folder_.empty() ? fs::path() : folder_ / (key + ".volume");
  if (!path.empty()) known = load(path, key);
  if (known != nullptr) return known;
  auto volume = std::make_shared<CarriedVolume>(make());
  ++made_;
  if (!path.empty()) save(path, key, *volume);
  return known = std::move(volume);
}

}  // namespace impinge
