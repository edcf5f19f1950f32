// A view in words, for pictures to say how they were looked at.
#pragma once

#include <string>

#include "viewer/draw/view_settings.hpp"

namespace impinge {

/// A line each, `PATH = VALUE`: the camera's rows, and those of view.* that are not as a session begins with.
std::string view_text(ViewSettings settings);

}  // namespace impinge
