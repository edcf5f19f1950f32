// The list of formats: one line each, in the order of --help.
#include <algorithm>

#include "viewer/export/exporter.hpp"

namespace impinge {

const Registry<Exporter>& exporters() {
  static const Registry<Exporter> list = [] {
    Registry<Exporter> all;
    IMPINGE_LIST(all, ply_exporter);
    IMPINGE_LIST(all, obj_exporter);
    IMPINGE_LIST(all, gltf_exporter);
    IMPINGE_LIST(all, vtu_exporter);
    IMPINGE_LIST(all, usda_exporter);
    IMPINGE_LIST(all, poses_csv_exporter);
    IMPINGE_LIST(all, poses_json_exporter);
    return all;
  }();
  return list;
}

std::string export_name(const std::filesystem::path& scene) {
  std::string name = scene.stem().string();
  const std::string_view kept = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  std::replace_if(
      name.begin(), name.end(), [&](char c) { return kept.find(c) == std::string_view::npos; }, '_');
  return name.empty() ? "scene" : name;
}

}  // namespace impinge
