// Where the contacts of a group will be when the sub-step ends, on the exact free rotation of its bodies.
#pragma once

#include "engine/contact/assemble.hpp"

namespace impinge {

/// Of the activation distance: what turning takes that is worth another solve; and of that: what rows are told, which costs
/// none.
inline constexpr double kTurningTolerance = 1e-3, kNotable = 1e-2;

/// Whether contacts of a body could notice that it turns by so many radians.
bool is_notable(double turn, const Body& body, const ContactSettings& settings);

struct EndRows {
  /// Metres; prescribed bodies end where their velocity takes them, nodes go straight. Infinite of attachments, of what
  /// nothing rigid takes part in, and where a body turns so far that one straight step can't mean it. Of what is round,
  /// or of facets finer than the turn, that of the place which touches then.
  std::vector<double> gaps;
  std::vector<Vec3> rolling;      ///< ContactRows::rolling as it would have to be, m/s; of rigid bodies on faces
  std::vector<char> is_on_face;   ///< whether they are of rigid bodies one of which looks at the other with a face
  std::vector<char> is_round;     ///< whether another place of the same surface will touch there
  std::vector<char> handed_over;  ///< whether such a row of the same pair answers for it
};

/// What rows count on: that bodies turn as they do at the Δv at hand.
enum class Trust {
  none,   ///< turning is told where it brings the points that touch nearer to each other
  lifts,  ///< and where it takes them apart, and what rolls
  facets  ///< and some rows answer for others of fine facets
};

/// With the group's Δv.
EndRows rows_at_end(const Bodies& bodies, const AssembledGroup& group, const ContactList& contacts,
                    const ContactSettings& settings, double time_step, Trust trust);

}  // namespace impinge
