// What a job's run said of its own answer that forbids to take it for one: a job that ended well may still have blown up.
#pragma once

#include <filesystem>
#include <string>

namespace impinge {

/// Of a run's output: bodies that may have passed others, or did, or overlap deeply; energy that nobody gave;
/// attachments apart; bodies crushed. In one line, "" for none of them.
std::string sweep_doubts(const std::filesystem::path& output);

}  // namespace impinge
