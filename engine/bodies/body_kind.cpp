#include "engine/bodies/body_kind.hpp"

namespace impinge {

const char* kind_name(BodyKind kind) {
  switch (kind) {
    case BodyKind::fixed:
      return "static";
    case BodyKind::scripted:
      return "scripted";
    case BodyKind::dynamic:
      return "dynamic";
    case BodyKind::deformable:
      return "deformable";
  }
  return "";
}

}  // namespace impinge
