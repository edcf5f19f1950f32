// Preflight of a session, and the sub-step that it may be asked to try.
#pragma once

#include "viewer/controller/session.hpp"
#include "viewer/preflight/preflight.hpp"

namespace impinge {

/// Frame 0 must not have been left.
Preflight preflight_of(const Session& session, const Trial* trial = nullptr);

/// The same scene once more, a sub-step of the same length, then frames for some seconds. Gives up after a minute. Throws what loading
/// a scene throws, and Interrupted.
Trial try_scene(const Session& session, const std::filesystem::path& scene, const std::vector<std::string>& overrides,
                const std::filesystem::path& script);

/// What it came to, in one or two lines without the last one's end: "trial: ...", "ahead: ...".
std::string trial_line(const Trial& trial, int frames);

}  // namespace impinge
