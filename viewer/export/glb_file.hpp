// The container of a glTF 2.0 scene with its numbers, .glb, and the parts of its JSON that are about numbers.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/types.hpp"

namespace impinge {

/// Numbers in one block, and the accessors that say what they are. All of them have four bytes.
class GlbBuffer {
 public:
  // each returns the accessor's place
  int add_points(std::span<const Eigen::Vector3f> points, bool of_vertices);
  int add_quaternions(std::span<const Eigen::Vector4f> values);  ///< x, y, z, w
  int add_numbers(std::span<const float> numbers);
  int add_corners(std::span<const Triangle> triangles);

  std::string accessors_json() const;
  std::string views_json() const;
  const std::string& bytes() const { return bytes_; }

 private:
  int add(std::string_view bytes, std::size_t count, const char* type, int component, int target,
          const std::string& range);

  std::string bytes_, accessors_, views_;
  int count_ = 0;
};

/// JSON in a file with the block behind it. Throws OutputError, and InputError (without a place) beyond the 4 GB that
/// the format counts to.
void write_glb(const std::filesystem::path& path, const std::string& json, const std::string& block);

}  // namespace impinge
