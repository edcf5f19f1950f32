// What of a sub-step's answer the next ones need.
#pragma once

#include <map>

#include "engine/step/sleeping.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

/// Keeps the impulses that the next sub-step starts from; sleepers keep theirs for the day they wake.
void remember_impulses(const Bodies& bodies, std::span<const GroupResult> results, ContactCache& cache);

/// What the results' contacts carry, to start another solve from.
ContactCache impulses_of(std::span<const GroupResult> results);

/// What contacts and attachments gave in the pieces of a sub-step before its last, so that what is shown is of all of it.
class EarlierPieces {
 public:
  explicit EarlierPieces(SubStep& step) : step_(step) { step.parted.clear(); }
  /// A piece is solved. What those before the last gave comes to its results: to the same contact, else to the nearest of
  /// its pair. Of a pair that has none any more those that carried come into step.parted.
  void close(const Bodies& bodies, bool is_last);

 private:
  void take();
  void give(const Bodies& bodies) const;
  struct Part {
    Vec3 impulse = Vec3::Zero();           // on A, world axes, N·s
    std::optional<SolvedContact> contact;  // where it acted last; none: an attachment's
  };
  SubStep& step_;
  std::map<ContactKey, Part> parts_;
};

/// (body, scripted body) of all contacts that were solved.
std::vector<BodyEnds> find_supports(const Bodies& bodies, std::span<const GroupResult> results);

/// By body, how fast recovery from overlap moved it, m/s; the groups' results in their order.
std::vector<double> push_out_speeds(const Bodies& bodies, std::span<const CollisionGroup> groups,
                                    std::span<const GroupResult> results);

}  // namespace impinge
