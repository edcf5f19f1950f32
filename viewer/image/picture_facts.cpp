#include "viewer/image/picture_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace impinge {

PictureFacts facts_of(const PngText& text) {
  PictureFacts facts;
  for (const auto& [keyword, value] : text) {
    if (keyword == "impinge:scene") facts.scene = value;
    if (keyword == "impinge:frame") facts.frame = value;
    if (keyword == "impinge:state_hash") facts.state_hash = value;
    if (keyword == "impinge:renderer") facts.renderer = value;
  }
  return facts;
}

ChangeCause cause_of(const PictureFacts& a, const PictureFacts& b) {
  if (a.state_hash.empty() || b.state_hash.empty()) return ChangeCause::unknown;
  if (a.scene != b.scene) return ChangeCause::other_scene;
  if (a.frame != b.frame) return ChangeCause::other_frame;
  if (a.state_hash != b.state_hash) return ChangeCause::state;
  return a.renderer != b.renderer ? ChangeCause::renderer : ChangeCause::drawing;
}

std::string cause_text(const PictureFacts& a, const PictureFacts& b) {
  switch (cause_of(a, b)) {
    case ChangeCause::unknown:
      return "";
    case ChangeCause::other_scene:
      return fmt::format("another scene (A shows {}, B {})", a.scene, b.scene);
    case ChangeCause::other_frame:
      return fmt::format("another frame (A shows frame {}, B frame {})", a.frame, b.frame);
    case ChangeCause::state:
      return fmt::format("the state changed (hash {} in A, {} in B)", a.state_hash, b.state_hash);
    case ChangeCause::drawing:
      return "only the drawing changed (or a shape, which the state hash leaves out): state and renderer are the same";
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
