// Options that take a list: one word each, or several words after one.
#pragma once

#include <string>
#include <vector>

namespace impinge {

/// The words of a command line with `--set`, `--vary`, `--reference` and `--column` before each of their values:
/// `--vary A=1 B=2` becomes `--vary A=1 --vary B=2`. A further value begins with NAME= or PATH=, so that a scene may
/// stand after such an option.
std::vector<std::string> repeat_options(const std::vector<std::string>& words);

}  // namespace impinge
