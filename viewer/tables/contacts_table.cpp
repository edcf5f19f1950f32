#include "viewer/tables/contacts_table.hpp"

#include <fmt/format.h>

#include "engine/core/parameter.hpp"

namespace impinge {

std::string contacts_header() {
  return "frame,body_a,body_b,triangle_a,triangle_b,pa_x,pa_y,pa_z,pb_x,pb_y,pb_z,n_x,n_y,n_z,gap_m,gap0_m,lambda_n,"
         "lambda_t1,lambda_t2,mu,state,pair_id";
}

std::string contacts_rows(const StepRecord& record) {
  std::string out;
  const auto add = [&out](const Vec3& v) {
    out += fmt::format(",{},{},{}", shortest(v.x()), shortest(v.y()), shortest(v.z()));
  };
  for (const ContactRecord& c : record.contacts) {
    out += fmt::format("{},{},{},{},{}", record.stats.frame, record.bodies[c.body_a].name, record.bodies[c.body_b].name,
                       c.triangle_a, c.triangle_b);
    add(c.point_a), add(c.point_b), add(c.normal);
    out += fmt::format(",{},{}", shortest(c.gap), shortest(c.gap0));
    add(c.lambda);
    out += fmt::format(",{},{},{}\n", shortest(c.friction), state_name(c.state), c.pair_id);
  }
  return out;
}

}  // namespace impinge
