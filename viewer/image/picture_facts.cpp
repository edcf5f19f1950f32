#include "viewer/image/picture_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

namespace impinge {

namespace {

/// Values by their paths.
std::map<std::string, std::string> rows_of(const std::string& view) {
  std::map<std::string, std::string> rows;
  for (std::size_t begin = 0; begin < view.size();) {
    const std::size_t end = std::min(view.find('\n', begin), view.size());
    const std::string line = view.substr(begin, end - begin);
    if (const std::size_t equals = line.find(" = "); equals != std::string::npos)
      rows[line.substr(0, equals)] = line.substr(equals + 3);
    begin = end + 1;
  }
  return rows;
}

constexpr std::string_view kCamera = "view.camera.";

}  // namespace

std::string view_changes(const PictureFacts& a, const PictureFacts& b) {
  if (a.view.empty() || b.view.empty() || a.view == b.view) return "";
  std::map<std::string, std::string> in_a = rows_of(a.view), in_b = rows_of(b.view);
  for (const auto& [path, value] : in_a) in_b.emplace(path, "as usual");
  for (const auto& [path, value] : in_b) in_a.emplace(path, "as usual");
  std::string camera, others;
  for (const auto& [path, value] : in_a) {
    const std::string& other = in_b.at(path);
    if (value == other) continue;
    const bool is_camera = path.starts_with(kCamera);
    std::string& list = is_camera ? camera : others;
    list += fmt::format("{}{} is {} in A, {} in B", list.empty() ? "" : "; ",
                        is_camera ? path.substr(kCamera.size()) : path, value, other);
  }
  if (camera.empty()) return others;
  return "the camera moved (" + camera + ")" + (others.empty() ? "" : ", and " + others);
}

PictureFacts facts_of(const PngText& text) {
  PictureFacts facts;
  for (const auto& [keyword, value] : text) {
    if (keyword == "impinge:scene") facts.scene = value;
    if (keyword == "impinge:frame") facts.frame = value;
    if (keyword == "impinge:state_hash") facts.state_hash = value;
    if (keyword == "impinge:renderer") facts.renderer = value;
    if (keyword == "impinge:view") facts.view = value;
  }
  return facts;
}

ChangeCause cause_of(const PictureFacts& a, const PictureFacts& b) {
  if (a.state_hash.empty() || b.state_hash.empty()) return ChangeCause::unknown;
  if (a.scene != b.scene) return ChangeCause::other_scene;
  if (a.frame != b.frame) return ChangeCause::other_frame;
  if (a.state_hash != b.state_hash) return ChangeCause::state;
  if (!view_changes(a, b).empty()) return ChangeCause::view;
  return a.renderer != b.renderer ? ChangeCause::renderer : ChangeCause::drawing;
}

std::string cause_text(const PictureFacts& a, const PictureFacts& b) {
  const std::string view = view_changes(a, b);
  switch (cause_of(a, b)) {
    case ChangeCause::unknown:
      return "";
    case ChangeCause::other_scene:
      return fmt::format("another scene (A shows {}, B {})", a.scene, b.scene);
    case ChangeCause::other_frame:
      return fmt::format("another frame (A shows frame {}, B frame {})", a.frame, b.frame);
    case ChangeCause::state:
      return fmt::format("the state changed (hash {} in A, {} in B){}{}", a.state_hash, b.state_hash,
                         view.empty() ? "" : ", and ", view);
    case ChangeCause::view:
      return "only the drawing changed, since " + view + ": the state is the same";
    case ChangeCause::drawing:
      return fmt::format(
          "only the drawing changed (or a shape, which the state hash leaves out): state{} and renderer are the same",
          a.view.empty() || b.view.empty() ? "" : ", view");
    case ChangeCause::renderer:
      return fmt::format("only the renderer changed (A by {}, B by {}): the state is the same", a.renderer, b.renderer);
  }
  return "";
}

std::string renderer_key(const std::string& renderer) {
  const auto word = [](const std::string& text) {
    std::string out;
    for (const char c : text)
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '.') out += c;
    return out;
  };
  const std::string first = word(renderer.substr(0, renderer.find(' ')));
  const std::size_t blank = renderer.rfind(' ');
  std::string key = first;
  if (blank != std::string::npos) key += "-" + word(renderer.substr(blank + 1));
  // the vector width, on which the last bits depend
  if (const std::size_t bits = renderer.find(" bits"); bits != std::string::npos) {
    std::size_t begin = bits;
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(renderer[begin - 1]))) --begin;
    if (begin < bits) key += "-" + renderer.substr(begin, bits - begin);
  }
  return key;
}

}  // namespace impinge
