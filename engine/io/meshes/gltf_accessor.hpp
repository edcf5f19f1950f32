// The numbers of glTF's accessors.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/io/meshes/tinygltf.hpp"

namespace impinge {

/// The elements of one accessor one after the other, `components` numbers each: any component type, spread over strides,
/// scaled to [-1, 1] where they are normalized, with the elements of a sparse accessor put in [Khronos21, 3.6.2]. Throws
/// InputError, worded to follow the file's name, where it isn't there, is of other components, or reaches beyond its
/// buffer; numbers that are not finite are left to the caller.
std::vector<double> gltf_numbers(const tinygltf::Model& model, int accessor, int components);

/// An accessor of single whole numbers of 0 or more, as indices are.
std::vector<std::uint32_t> gltf_indices(const tinygltf::Model& model, int accessor);

/// The element of an array of the document; throws InputError where it has none of that number.
template <typename T>
const T& gltf_element(const std::vector<T>& of, int number, const char* what) {
  if (number < 0 || number >= static_cast<std::ptrdiff_t>(of.size()))
    throw InputError(std::string(what) + " " + std::to_string(number) + " is named, of " + std::to_string(of.size()));
  return of[static_cast<std::size_t>(number)];
}

}  // namespace impinge
