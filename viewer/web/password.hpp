// The password of a door to the debugger that others on the machine or the network can see.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace impinge {

/// Sixteen letters and digits that are easily told apart, from the system's source of randomness.
std::string random_password();
/// A file's first line. Throws InputError where there is none, where it is shorter than 8 or longer than 128 characters or
/// not printable ASCII.
std::string read_password(const std::filesystem::path& file);
/// Takes as long for any two texts of that length, so that nobody learns from the time how much he guessed.
bool is_same_password(std::string_view given, std::string_view wanted);

}  // namespace impinge
