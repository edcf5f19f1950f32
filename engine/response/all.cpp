// The list of collision responses: one line each.
#include "engine/response/response.hpp"

namespace impinge {

Entry<Response> constraint_anticipation_response();
Entry<Response> iterative_constraint_anticipation_response();

const Registry<Response>& responses() {
  static const Registry<Response> list = {constraint_anticipation_response(), iterative_constraint_anticipation_response()};
  return list;
}

}  // namespace impinge
