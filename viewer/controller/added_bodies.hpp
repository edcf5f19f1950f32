// Bodies that lines add to a scene. Every one that will come is in the world from the start, absent, so that lines may name
// it; the list is a function of the lines alone: behind the scene's own bodies, in the order in which they come to life.
#pragma once

#include <span>

#include "engine/io/scene/scene.hpp"
#include "viewer/controller/command.hpp"

namespace impinge {

/// A line that adds a body with a frame.
struct Addition {
  int frame = 0;
  Act act;
  std::string place = {};  ///< "file:line:column"; "": of a line by hand
};

class AddedBodies {
 public:
  /// Those that a script's lines add; the other lines are for whoever reads the script. Throws InputError where one can't
  /// be added.
  void read(const std::string& name, const std::vector<std::string>& lines, const Scene& scene, World& world,
            ParameterSet& rows);
  /// Has the world those of the script and these; of one frame these come first. True: the list is another now. Throws
  /// InputError where one can't be added, the list then to be made once more.
  bool list(std::vector<Addition> by_hand, const Scene& scene, World& world, ParameterSet& rows);
  /// Throws InputError, without a place, where there can be no such body.
  void check(const Act& act, const Scene& scene) const;

  /// How many rows there are but for those of absent bodies, which come last.
  std::size_t rows_present(const Bodies& bodies, const ParameterSet& rows) const;

 private:
  void add(const Addition& addition, const Scene& scene, World& world, ParameterSet& rows);

  std::vector<Addition> of_script_;
  std::vector<Act> acts_;                // of all, in their order
  std::vector<std::size_t> first_rows_;  // and how many rows there are before theirs
};

/// What to say of bodies that these commands have added into others; "": nothing. `record`: of the frame that shows them
/// first.
std::string overlap_note(std::span<const Command> commands, const StepRecord& record);

}  // namespace impinge
