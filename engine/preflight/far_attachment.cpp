// Attachments whose point is so far outside a body that its numbers are in another unit. An arm without a mass is no error.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kFarthest = 10.0;  // times as far as the body reaches

class FarAttachment : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    std::vector<std::pair<double, Finding>> found;
    std::set<int> seen;  // a line is held by two
    const Bodies& bodies = start.world.bodies();
    for (const Attachment& attachment : start.world.attachments()) {
      if (!seen.insert(attachment.number).second) continue;
      for (const AttachmentEnd* end : {&attachment.a, &attachment.b}) {
        if (end == &attachment.b && attachment.kind != AttachmentKind::point) continue;  // what it carries is endless
        if (end->body.is_none() || !bodies[end->body].has_freedom()) continue;
        const Body& body = bodies[end->body];
        const double away = (end->position(bodies) - body.pose.position).norm();
        if (!(body.radius > 0.0 && away > kFarthest * body.radius)) continue;  // of what deforms it is in it anyway
        found.emplace_back(away / body.radius, Finding{fmt::format("attachment '{}' has its point {} from the middle "
                                                                   "of '{}', {:.3g} times as far as that reaches ({})",
                                                                   attachment.name, length_text(away), body.name,
                                                                   away / body.radius, length_text(body.radius)),
                                                       "`point` is a place of the world, in metres: mend it, or "
                                                       "silence this where an arm without a mass is meant"});
      }
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& l, const auto& r) { return l.first > r.first; });
    std::vector<Finding> list;
    for (auto& [share, finding] : found) list.push_back(std::move(finding));
    return list;
  }
};

}  // namespace

Entry<Warning> far_attachment_warning() {
  return entry<Warning, FarAttachment>("far-attachment",
                                       "an attachment's point is over ten times as far from a body as that reaches");
}

}  // namespace impinge
