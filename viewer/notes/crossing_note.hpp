// What a run must not keep to its figures: deformable bodies that came to cross themselves though they are told to keep off
// themselves.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace impinge {

class NoteArchive;
class World;

/// How its lines are known in a run's output.
inline constexpr std::string_view kCrossesMark = "crosses itself";

class CrossingNote {
 public:
  /// The world at the end of a frame, and at the start.
  void add(const World& world);
  /// A line a body, with its end; "" if none crosses itself in more places than at the start.
  std::string text() const;
  void keep(NoteArchive& archive);

 private:
  struct Crossed {
    std::int64_t at_start = 0, most = 0;  // pairs of triangles
    int first = 0, worst = 0;             // frames
  };
  std::map<std::string, Crossed> bodies_;  // by name
};

}  // namespace impinge
