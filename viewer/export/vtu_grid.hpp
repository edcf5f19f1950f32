// VTK's unstructured grid as a file, .vtu: XML with the numbers raw behind it, doubles as doubles.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/types.hpp"

namespace impinge {

/// One of VTK's kinds of cells, by its number.
enum class VtuCell : std::uint8_t { vertex = 1, triangle = 5, tetrahedron = 10 };

class VtuGrid {
 public:
  std::vector<Vec3> points;

  /// Corners count from `first`.
  template <std::size_t Corners>
  void add_cell(VtuCell kind, const std::array<int, Corners>& corners, std::int64_t first) {
    for (const int corner : corners) connectivity_.push_back(first + corner);
    offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
    kinds_.push_back(static_cast<std::uint8_t>(kind));
  }
  void add_vertex_cell() { add_cell(VtuCell::vertex, std::array{0}, static_cast<std::int64_t>(offsets_.size())); }

  // one entry a point or a cell; `components` numbers each
  void add_point_field(const std::string& name, std::span<const double> values, int components = 1);
  void add_point_field(const std::string& name, std::span<const Vec3> values);
  void add_point_field(const std::string& name, std::span<const int> values);
  void add_cell_field(const std::string& name, std::span<const double> values, int components = 1);
  void add_cell_field(const std::string& name, std::span<const int> values);

  /// Throws OutputError.
  void write(const std::filesystem::path& path) const;

 private:
  struct Field {
    std::string name, type;
    int components;
    std::string bytes;
  };
  std::vector<Field> point_fields_, cell_fields_;
  std::vector<std::int64_t> connectivity_, offsets_;
  std::vector<std::uint8_t> kinds_;
};

}  // namespace impinge
