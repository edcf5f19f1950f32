// What a run must not keep to its figures: soft bodies that the integrator swells while they turn.
#pragma once

#include <map>
#include <string>

namespace impinge {

class NoteArchive;
class World;

class SwellNote {
 public:
  /// The world at the end of a frame.
  void add(const World& world);
  /// A line a body, with its end; "" if none was swollen by an energy worth a word.
  std::string text() const;
  void keep(NoteArchive& archive);

 private:
  struct Swollen {
    int frame = 0;  // the worst
    double strain = 0.0, turn = 0.0, energy = 0.0, kinetic = 0.0;
  };
  std::map<std::string, Swollen> bodies_;  // by name
};

}  // namespace impinge
