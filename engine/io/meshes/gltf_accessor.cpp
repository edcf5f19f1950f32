#include "engine/io/meshes/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "engine/io/meshes/mesh_readers.hpp"

namespace impinge {
namespace {

template <typename T>
double number_of(const unsigned char* at, bool normalized) {
  T value;
  std::memcpy(&value, at, sizeof value);
  const auto number = static_cast<double>(value);
  if constexpr (std::is_integral_v<T>) {
    if (normalized) return std::max(number / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
  }
  return number;
}

using Reader = double (*)(const unsigned char*, bool);

struct ComponentType {
  int type;
  std::size_t bytes;
  Reader read;
};

constexpr ComponentType kComponentTypes[] = {
    {TINYGLTF_COMPONENT_TYPE_BYTE, 1, number_of<std::int8_t>},
    {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 1, number_of<std::uint8_t>},
    {TINYGLTF_COMPONENT_TYPE_SHORT, 2, number_of<std::int16_t>},
    {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 2, number_of<std::uint16_t>},
    {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 4, number_of<std::uint32_t>},
    {TINYGLTF_COMPONENT_TYPE_FLOAT, 4, number_of<float>},
};

const ComponentType& component_type(int type) {
  for (const ComponentType& known : kComponentTypes)
    if (known.type == type) return known;
  throw InputError(fmt::format("numbers of type {}", type));
}

/// `count` elements of `size` bytes, `stride` apart (0: as the view says, or one behind the other).
struct Elements {
  const unsigned char* first;
  std::size_t stride;
};

Elements elements_of(const tinygltf::Model& model, int view_number, std::size_t offset, std::size_t count,
                     std::size_t size) {
  const tinygltf::BufferView& view = gltf_element(model.bufferViews, view_number, "buffer view");
  const std::vector<unsigned char>& bytes = gltf_element(model.buffers, view.buffer, "buffer").data;
  const std::size_t stride = view.byteStride > 0 ? view.byteStride : size;
  const std::size_t end = std::min(bytes.size(), view.byteLength);  // of the view, counted from where it begins
  if (view.byteOffset > bytes.size() || end > bytes.size() - view.byteOffset || offset > end || size > end - offset ||
      count - 1 > (end - offset - size) / stride)
    throw InputError(
        fmt::format("buffer view {} is read beyond its end: {} elements of {} bytes", view_number, count, size));
  return {bytes.data() + view.byteOffset + offset, stride};
}

void put_sparse_in(const tinygltf::Model& model, const tinygltf::Accessor& accessor, int components,
                   std::vector<double>& numbers) {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 1 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    throw InputError("a sparse accessor without elements");
  const auto count = static_cast<std::size_t>(sparse.count), width = static_cast<std::size_t>(components);
  const ComponentType& index = component_type(sparse.indices.componentType);
  const ComponentType& value = component_type(accessor.componentType);
  const Elements indices = elements_of(model, sparse.indices.bufferView,
                                       static_cast<std::size_t>(sparse.indices.byteOffset), count, index.bytes);
  const Elements values = elements_of(model, sparse.values.bufferView,
                                      static_cast<std::size_t>(sparse.values.byteOffset), count, value.bytes * width);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = index.read(indices.first + i * indices.stride, false);
    if (!(at >= 0.0) || at >= static_cast<double>(accessor.count))
      throw InputError(fmt::format("a sparse accessor names element {} of {}", at, accessor.count));
    for (std::size_t k = 0; k < width; ++k)
      numbers[static_cast<std::size_t>(at) * width + k] =
          value.read(values.first + i * values.stride + k * value.bytes, accessor.normalized);
  }
}

}  // namespace

std::vector<double> gltf_numbers(const tinygltf::Model& model, int number, int components) {
  const tinygltf::Accessor& accessor = gltf_element(model.accessors, number, "accessor");
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != components)
    throw InputError(fmt::format("accessor {} has other than {} numbers an element", number, components));
  if (accessor.count < 1) return {};
  if (accessor.count > static_cast<std::size_t>(kMostElements))
    throw InputError(fmt::format("accessor {} has {} elements", number, accessor.count));
  const bool sparse = accessor.sparse.isSparse;
  if (accessor.bufferView < 0 && !sparse) throw InputError(fmt::format("accessor {} has no numbers", number));

  const ComponentType& component = component_type(accessor.componentType);
  const auto width = static_cast<std::size_t>(components);
  std::vector<double> numbers(accessor.count * width, 0.0);
  if (accessor.bufferView >= 0) {
    const Elements from =
        elements_of(model, accessor.bufferView, accessor.byteOffset, accessor.count, component.bytes * width);
    for (std::size_t i = 0; i < accessor.count; ++i)
      for (std::size_t k = 0; k < width; ++k)
        numbers[i * width + k] =
            component.read(from.first + i * from.stride + k * component.bytes, accessor.normalized);
  }
  if (sparse) put_sparse_in(model, accessor, components, numbers);
  return numbers;
}

std::vector<std::uint32_t> gltf_indices(const tinygltf::Model& model, int number) {
  if (gltf_element(model.accessors, number, "accessor").componentType == TINYGLTF_COMPONENT_TYPE_FLOAT)
    throw InputError(fmt::format("accessor {} has fractions for indices", number));
  const std::vector<double> numbers = gltf_numbers(model, number, 1);
  std::vector<std::uint32_t> indices;
  indices.reserve(numbers.size());
  for (const double value : numbers) {
    if (value < 0.0) throw InputError(fmt::format("accessor {} has {} for an index", number, value));
    indices.push_back(static_cast<std::uint32_t>(value));
  }
  return indices;
}

}  // namespace impinge
