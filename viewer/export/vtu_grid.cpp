#include "viewer/export/vtu_grid.hpp"

#include <fmt/format.h>

#include <bit>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"

namespace impinge {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

template <class T>
std::string bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

void VtuGrid::add_point_field(const std::string& name, std::span<const double> values, int components) {
  IMPINGE_ASSERT(values.size() == points.size() * static_cast<std::size_t>(components));
  point_fields_.push_back({name, "Float64", components, bytes_of(values)});
}

void VtuGrid::add_point_field(const std::string& name, std::span<const Vec3> values) {
  IMPINGE_ASSERT(values.size() == points.size());
  point_fields_.push_back({name, "Float64", 3, bytes_of(values)});
}

void VtuGrid::add_point_field(const std::string& name, std::span<const int> values) {
  IMPINGE_ASSERT(values.size() == points.size());
  point_fields_.push_back({name, "Int32", 1, bytes_of(values)});
}

void VtuGrid::add_cell_field(const std::string& name, std::span<const double> values, int components) {
  IMPINGE_ASSERT(values.size() == offsets_.size() * static_cast<std::size_t>(components));
  cell_fields_.push_back({name, "Float64", components, bytes_of(values)});
}

void VtuGrid::add_cell_field(const std::string& name, std::span<const int> values) {
  IMPINGE_ASSERT(values.size() == offsets_.size());
  cell_fields_.push_back({name, "Int32", 1, bytes_of(values)});
}

void VtuGrid::write(const std::filesystem::path& path) const {
  std::vector<Field> arrays = point_fields_;
  arrays.insert(arrays.end(), cell_fields_.begin(), cell_fields_.end());
  arrays.push_back({"Points", "Float64", 3, bytes_of(std::span(points))});
  arrays.push_back({"connectivity", "Int64", 1, bytes_of(std::span(connectivity_))});
  arrays.push_back({"offsets", "Int64", 1, bytes_of(std::span(offsets_))});
  arrays.push_back({"types", "UInt8", 1, bytes_of(std::span(kinds_))});

  // The blocks stand behind the XML in reverse order, each with its length before it: meshio 5.3 looks an element up by its
  // offset while it writes new offsets into those of the blocks before, and takes the first that it finds.
  std::vector<std::string> elements(arrays.size());
  std::string blocks;
  for (std::size_t i = arrays.size(); i-- > 0;) {
    const Field& f = arrays[i];
    elements[i] = fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n", f.type, f.name,
        f.components == 1 ? "" : fmt::format(" NumberOfComponents=\"{}\"", f.components), blocks.size());
    const std::uint64_t size = f.bytes.size();
    blocks.append(reinterpret_cast<const char*>(&size), sizeof size);
    blocks += f.bytes;
  }
  std::string xml = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      points.size(), offsets_.size());
  auto next = elements.begin();
  for (const auto& [name, count] : {std::pair("PointData", point_fields_.size()),
                                    {"CellData", cell_fields_.size()},
                                    {"Points", std::size_t{1}},
                                    {"Cells", std::size_t{3}}}) {
    xml += fmt::format("      <{}>\n", name);
    for (std::size_t k = 0; k < count; ++k) xml += *next++;
    xml += fmt::format("      </{}>\n", name);
  }
  xml += "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_" + blocks +
         "\n  </AppendedData>\n</VTKFile>\n";
  write_file(path, xml);
}

}  // namespace impinge
