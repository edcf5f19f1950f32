// What of a scene is modelled, and what is left out because nothing in it asks for it: for `impinge info` and the
// report of a sweep, which knows a job by its run.toml only.
#pragma once

#include <filesystem>
#include <map>

#include "engine/world/world.hpp"

namespace impinge {

struct ModelFacts {
  int fixed = 0, scripted = 0, dynamic = 0, deformable = 0;
  int points = 0, lines = 0, planes = 0, surfaces = 0;  ///< attachments, by kind
  int deformable_dofs = 0;                              ///< degrees of freedom of the deformable bodies; -1: not known
  bool friction = false;                                ///< some body has friction
  bool frictionless = false;                            ///< some body has none, so that its contacts have one row
  bool restitution = false, mesh_pairs = false, self_collision = false;
  /// Sizes of bodies, metres: the least of all, and of those that move freely; 0: not known.
  double thinnest = 0.0, smallest = 0.0, largest = 0.0;
  std::vector<std::string> exempt;  ///< pairs that an attachment keeps from touching: "lid and shelf ('tag')"
  int attachments() const { return points + lines + planes + surfaces; }
  int attachment_rows() const { return 3 * points + 2 * lines + planes + surfaces; }
  int moving() const { return dynamic + deformable; }
  bool meets() const { return moving() > 0 && (moving() + fixed + scripted > 1 || self_collision); }
};

ModelFacts model_facts(const World& world);

/// Parameters and facts of a run, from its run.toml, without the meshes; false where the file is missing or says less
/// than that.
bool read_recorded_model(const std::filesystem::path& run_toml, Parameters& parameters, ModelFacts& facts);

struct ModelLine {
  std::string stage;  ///< "friction"
  bool used = false;
  std::string what;  ///< how it is modelled, or why it is left out
};

std::vector<ModelLine> model_lines(const Parameters& parameters, const ModelFacts& facts);

}  // namespace impinge
