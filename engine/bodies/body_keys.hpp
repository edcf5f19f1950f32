// What a scene says of a body in numbers and words: unit, range and meaning of each key, declared once for whoever
// reads, changes or lists them. Keys with a form of their own (shape, surface, motion, volume, fixed) are io/scene's.
#pragma once

#include <string_view>

#include "engine/bodies/body_kind.hpp"
#include "engine/core/parameter.hpp"

namespace impinge {

struct BodyKey {
  std::string_view name;  ///< below `body.NAME.`
  ParameterKind kind = ParameterKind::real;
  std::string_view unit;
  Range range;
  std::string_view doc;
  std::string_view word = {};  ///< the word that leaves it to the scene
};

/// Throws InternalError on a name that is not there.
const BodyKey& body_key(std::string_view name);

/// The row `path`.NAME of a key, which reads and writes by `get` and `set`; without a `set` it is fixed with the
/// scene.
Parameter body_row(const std::string& path, std::string_view name, std::function<ParameterValue()> get,
                   std::function<void(const ParameterValue&)> set);

}  // namespace impinge
