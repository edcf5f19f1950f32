// Impacts one after another within a sub-step. A row whose gap closes because of what another impact did in the same
// sub-step has no approach before it that could be reflected: it is braked to touch at the end, and what it should have
// rebounded with is lost. So the sub-step is cut where the first such gap closes, and the rest of it begins with an
// approach. So it is of what two that strike each other come upon of one another: a box that lands on one edge comes down on
// the other. (Gaps of nothing close together: they are one impact, solved as one.)
#pragma once

#include <map>
#include <optional>

#include "engine/bodies/bodies.hpp"
#include "engine/contact/contact_settings.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

/// Whether any two bodies rebound from each other with a part of their energy that is worth a cut, a tenth or more.
bool has_rebounds(const Bodies& bodies, const ContactSettings& settings);

/// Of a step that is solved: the share of it after which the first gap closes, if a row was braked that ought to rebound.
/// Rigid bodies only. `gravity`: of scale_gravity, m/s².
std::optional<double> share_to_first_impact(const Bodies& bodies, const SubStep& step, const ContactSettings& settings,
                                            double gravity);

/// Rebounds that would win energy are made weaker until they don't. Two ways lead there. Where one row rebounds while
/// another, which its bodies' free motion leaves open, is braked, neither knows that the other came first: so it is after
/// cuts, and with bodies that stand in one another. And where
/// friction turns the slip of a point round that rebounds (a rod that strikes the floor aslant), its work and that of
/// Newton's restitution may be more than nothing [Stronge90]. Without any rebound impulses only take.
/// Of each group of rigid bodies one share of all its rebounds is sought, the largest that wins nothing, by motions that
/// are made anew.
class PassiveRebounds {
 public:
  /// Of a step that is solved: changes SubStep::rebounds and says true where the motion has to be made anew. `was_cut`:
  /// for impacts one after another, as often as it may be.
  bool weaken(const Bodies& bodies, SubStep& step, const ContactSettings& settings, bool was_cut);

 private:
  static constexpr int kMotions = 6;  // of a search
  struct Search {
    double low = 0.0, high = 1.0;   // shares that win nothing, and something
    double taken = 0.0, won = 0.0;  // J: what impulses took with the lower, won with the higher; 0: nobody has looked
    double share = 1.0;             // of the motion that is looked at
    int left = kMotions;
    bool is_again = false;  // rows came when it was over
  };
  std::map<BodyIndex, Search> groups_;  // by lowest body
};

}  // namespace impinge
