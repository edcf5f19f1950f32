// The list of collision responses: one line each.
#include "engine/response/response.hpp"

namespace impinge {

Entry<Response> constraint_anticipation_response();
Entry<Response> iterative_constraint_anticipation_response();
Entry<Response> penalty_response();
Entry<Response> sequential_impulse_response();
Entry<Response> simultaneous_impulse_response();
Entry<Response> soft_constraint_response();

const Registry<Response>& responses() {
  static const Registry<Response> list = {constraint_anticipation_response(),
                                          iterative_constraint_anticipation_response(),
                                          penalty_response(),
                                          sequential_impulse_response(),
                                          simultaneous_impulse_response(),
                                          soft_constraint_response()};
  return list;
}

}  // namespace impinge
