#include "viewer/export/glb_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <limits>

#include "engine/io/file.hpp"
#include "engine/io/little_endian.hpp"

namespace impinge {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

constexpr int kFloat = 5126, kUnsigned = 5125;                     // components
constexpr int kNoTarget = 0, kVertices = 34962, kCorners = 34963;  // what a view is for

template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

int GlbBuffer::add(std::string_view bytes, std::size_t count, const char* type, int component, int target,
                   const std::string& range) {
  const char* comma = count_ == 0 ? "" : ",\n";
  views_ += fmt::format("{}{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}{}}}", comma, bytes_.size(), bytes.size(),
                        target == kNoTarget ? "" : fmt::format(",\"target\":{}", target));
  accessors_ += fmt::format("{}{{\"bufferView\":{},\"componentType\":{},\"count\":{},\"type\":\"{}\"{}}}", comma,
                            count_, component, count, type, range);
  bytes_ += bytes;
  return count_++;
}

int GlbBuffer::add_points(std::span<const Eigen::Vector3f> points, bool of_vertices) {
  std::string range;
  if (of_vertices) {
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& x : points) box.extend(x);
    const Eigen::Vector3f &a = box.min(), &b = box.max();
    range = fmt::format(",\"min\":[{},{},{}],\"max\":[{},{},{}]", a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
  }
  return add(bytes_of(points), points.size(), "VEC3", kFloat, of_vertices ? kVertices : kNoTarget, range);
}

int GlbBuffer::add_quaternions(std::span<const Eigen::Vector4f> values) {
  return add(bytes_of(values), values.size(), "VEC4", kFloat, kNoTarget, "");
}

int GlbBuffer::add_numbers(std::span<const float> numbers) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float x : numbers) low = std::min(low, x), high = std::max(high, x);
  return add(bytes_of(numbers), numbers.size(), "SCALAR", kFloat, kNoTarget,
             fmt::format(",\"min\":[{}],\"max\":[{}]", low, high));
}

int GlbBuffer::add_corners(std::span<const Triangle> triangles) {
  return add(bytes_of(triangles), 3 * triangles.size(), "SCALAR", kUnsigned, kCorners, "");
}

std::string GlbBuffer::accessors_json() const { return "[" + accessors_ + "]"; }
std::string GlbBuffer::views_json() const { return "[" + views_ + "]"; }

void write_glb(const std::filesystem::path& path, const std::string& json, const std::string& block) {
  constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJson = 0x4E4F534A, kBinary = 0x004E4942;
  std::string text = json;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::uint64_t size = 12 + 8 + std::uint64_t{text.size()} + 8 + block.size();
  if (size > std::numeric_limits<std::uint32_t>::max())
    throw InputError(fmt::format("{}: would have {} MB; a .glb has at most 4096; take fewer frames or another format",
                                 path.string(), size >> 20));
  LittleEndianWriter head, middle;
  head.put(kMagic), head.put(kVersion), head.put(static_cast<std::uint32_t>(size));
  head.put(static_cast<std::uint32_t>(text.size())), head.put(kJson);
  middle.put(static_cast<std::uint32_t>(block.size())), middle.put(kBinary);
  write_file(path, head.bytes() + text + middle.bytes() + block);
}

}  // namespace impinge
