// What a run must not keep to its table: energy that nobody gave, and attachments that came apart.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/notes/energy_rise.hpp"

namespace impinge {

class NoteArchive;
class World;

/// How its two kinds of lines are known in a run's output.
inline constexpr std::string_view kEnergyMark = "energy that nobody gave", kApartMark = "came apart in frame";

class BalanceNote {
 public:
  /// A frame of an earlier process, of which only the energies are known.
  void add_earlier(const FrameEnergy& energy, bool is_driven);
  /// The world at the end of a frame. `is_driven`: somebody did something to it that may give energy before that frame;
  /// what comes before frame 0 is how it begins.
  void add(const World& world, bool is_driven);
  /// Lines with their ends; "" if nothing rose and all held.
  std::string text() const;
  /// All but the energies: of these only how many, and add_earlier() has given them.
  void keep(NoteArchive& archive);

 private:
  struct Apart {
    std::string name, smaller;     // of the attachment; of the smaller body that it holds
    double size = 0.0;             // of that, metres
    bool was_held = false;         // since the start
    int first = -1, worst = -1;    // frames
    double gap = 0.0, most = 0.0;  // in these, metres
  };
  void begin(const World& world);
  void take_attachments(const World& world);
  std::string energy_text() const;
  std::string attachments_text() const;

  std::vector<FrameEnergy> energies_;  // up to where something from outside acts
  std::map<int, Apart> attachments_;   // by their numbers
  bool has_begun_ = false, is_driven_ = false;
  double least_ = 0.0;  // J: what bodies have that rest
  std::string remedy_, attachment_remedy_;
};

}  // namespace impinge
