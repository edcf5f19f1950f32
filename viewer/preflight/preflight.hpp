// All warnings of a scene, but for those that it silences.
#pragma once

#include "engine/preflight/warning.hpp"
#include "viewer/preflight/view_warning.hpp"

namespace impinge {

/// A warning's code and what it is about.
struct WarningName {
  std::string_view code, doc;
};
/// Of the model and of the view, in the order in which they are told.
std::vector<WarningName> warning_names();

/// Declares the row check.silence. The set refers to the list.
void bind_silence(ParameterSet& rows, std::vector<std::string>& silenced);

struct Warned {
  std::string_view code;
  std::vector<Finding> findings;
};

struct Preflight {
  std::vector<Warned> told;   ///< with something to say
  std::size_t silenced = 0;   ///< findings that the scene silences
  std::size_t count() const;  ///< of findings that are told
};

Preflight preflight(const SceneAtStart& scene, const ViewAtStart& view, const std::vector<std::string>& silenced);

/// A line each, `warning: CODE: text: remedy`, five of a code at most.
std::string warning_lines(const Preflight& preflight);

}  // namespace impinge
