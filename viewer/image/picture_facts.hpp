// What a frame's PNG says of itself, and what two of them tell about why they differ.
#pragma once

#include <filesystem>
#include <string>

#include "viewer/image/png.hpp"

namespace impinge {

/// From the tEXt chunks impinge:scene, :frame, :state_hash, :renderer and :view; "" where there is none.
struct PictureFacts {
  std::string scene, frame, state_hash, renderer;
  std::string view = {};  ///< lines PATH = VALUE (layers/view_text)
};

PictureFacts facts_of(const PngText& text);

enum class ChangeCause {
  unknown,  ///< a picture without these chunks
  other_scene,
  other_frame,
  state,     ///< the simulation gave another state
  drawing,   ///< the same state was drawn otherwise
  view,      ///< the same state, looked at otherwise: camera, layers, ...
  renderer,  ///< the same state, by another renderer
};

ChangeCause cause_of(const PictureFacts& a, const PictureFacts& b);

/// A sentence's part without its end: "the state changed (hash 0123... in A, 4567... in B)". "" for unknown.
std::string cause_text(const PictureFacts& a, const PictureFacts& b);

/// What differs between two views, in words: "the camera moved (eye is [...] in A, ...)"; "" where nothing does, or one
/// isn't known.
std::string view_changes(const PictureFacts& a, const PictureFacts& b);

/// A renderer as part of a file's name: "llvmpipe-22.3.6-256" of "llvmpipe (LLVM 15.0.6, 256 bits) 22.3.6".
std::string renderer_key(const std::string& renderer);

}  // namespace impinge
