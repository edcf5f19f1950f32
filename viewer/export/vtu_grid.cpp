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

/// The blocks behind the XML, each with its length before it, and the elements that say where they begin.
class Appended {
 public:
  std::string array(const std::string& name, const std::string& type, int components, std::string_view bytes) {
    const std::string element =
        fmt::format("        <DataArray type=\"{}\" Name=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n", type, name,
                    components == 1 ? "" : fmt::format(" NumberOfComponents=\"{}\"", components), blocks_.size());
    const std::uint64_t size = bytes.size();
    blocks_.append(reinterpret_cast<const char*>(&size), sizeof size);
    blocks_ += bytes;
    return element;
  }
  const std::string& blocks() const { return blocks_; }

 private:
  std::string blocks_;
};

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
  Appended data;
  std::string xml = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      points.size(), offsets_.size());
  const auto section = [&](const char* name, const std::vector<Field>& fields) {
    xml += fmt::format("      <{}>\n", name);
    for (const Field& f : fields) xml += data.array(f.name, f.type, f.components, f.bytes);
    xml += fmt::format("      </{}>\n", name);
  };
  section("PointData", point_fields_);
  section("CellData", cell_fields_);
  xml += "      <Points>\n" + data.array("Points", "Float64", 3, bytes_of(std::span(points))) + "      </Points>\n";
  xml += "      <Cells>\n" + data.array("connectivity", "Int64", 1, bytes_of(std::span(connectivity_))) +
         data.array("offsets", "Int64", 1, bytes_of(std::span(offsets_))) +
         data.array("types", "UInt8", 1, bytes_of(std::span(kinds_))) + "      </Cells>\n";
  xml += "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_" + data.blocks() +
         "\n  </AppendedData>\n</VTKFile>\n";
  write_file(path, xml);
}

}  // namespace impinge
