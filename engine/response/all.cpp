// The list of collision responses: one line each. The first is the default.
#include "engine/response/response.hpp"

namespace impinge {

const Registry<Response>& responses() {
  static const Registry<Response> list = [] {
    Registry<Response> all;
    IMPINGE_LIST(all, constraint_anticipation_response);
    IMPINGE_LIST(all, iterative_constraint_anticipation_response);
    IMPINGE_LIST(all, penalty_response);
    IMPINGE_LIST(all, sequential_impulse_response);
    IMPINGE_LIST(all, simultaneous_impulse_response);
    IMPINGE_LIST(all, soft_constraint_response);
    IMPINGE_LIST(all, quick_response);
    return all;
  }();
  return list;
}

}  // namespace impinge
