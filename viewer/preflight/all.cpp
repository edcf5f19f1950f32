// The list of warnings about the view: one line each, in the order in which they are told.
#include "viewer/preflight/view_warning.hpp"

namespace impinge {

const Registry<ViewWarning>& view_warnings() {
  static const Registry<ViewWarning> list = [] {
    Registry<ViewWarning> all;
    IMPINGE_LIST(all, out_of_view_warning);
    IMPINGE_LIST(all, missing_letters_warning);
    return all;
  }();
  return list;
}

}  // namespace impinge
