#include "viewer/state/debug_model.hpp"

namespace impinge {

const std::vector<std::string>& contact_columns() {
  static const std::vector<std::string> names = {"index", "a", "b", "gap", "normal", "friction", "state"};
  return names;
}

}  // namespace impinge
