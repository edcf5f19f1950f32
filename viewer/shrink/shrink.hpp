// A bundle made small: bodies, attachments, lines of the script, frames and triangles go as long as a condition still
// comes true. Every attempt is a whole scene that is run from its beginning; what is kept is what was seen to do it, so
// the order of attempts decides which of several small scenes comes out, and it is always the same.
#pragma once

#include <functional>

#include "viewer/bundle/bundle.hpp"

namespace impinge {

struct ShrinkOptions {
  std::filesystem::path bundle, out;
  std::string condition;
};

struct SceneSize {
  std::size_t bodies = 0, attachments = 0, commands = 0;
  std::size_t triangles = 0;  ///< of the files of surfaces
  int frames = 0;             ///< that are made until the condition is true, frame 0 among them
};

struct ShrinkProgress {
  SceneSize size;           ///< the smallest by now
  const char* at = "";      ///< what is being taken out
  int tried = 0, left = 0;  ///< scenes; those left if nothing more can go
};

struct ShrinkResult {
  SceneSize before, after;
  int tried = 0;
  bool interrupted = false;
  std::vector<std::string> notes;  ///< what wasn't tried, and why
};

/// Writes the smallest bundle by now whenever there is a smaller one. Throws InputError, with nothing written, where the
/// condition doesn't come true in the bundle's frames.
ShrinkResult shrink(const ShrinkOptions& options, const std::function<void(const ShrinkProgress&)>& watch);

}  // namespace impinge
