#include "viewer/export/pvd_file.hpp"

#include <fmt/format.h>

#include "engine/io/file.hpp"

namespace impinge {

void PvdFile::add(double time, int part, const std::filesystem::path& file) {
  entries_ += fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"{}\" file=\"{}\"/>\n", time, part,
                          file.filename().string());
}

void PvdFile::write() const {
  write_file(path_,
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
             "  <Collection>\n" +
                 entries_ + "  </Collection>\n</VTKFile>\n");
}

}  // namespace impinge
