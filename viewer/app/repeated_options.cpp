#include "viewer/app/repeated_options.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace impinge {
namespace {

constexpr std::string_view kRepeated[] = {"--set", "--vary", "--reference", "--column"};

bool is_assignment(std::string_view word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string_view::npos || equals == 0) return false;
  if (std::isdigit(static_cast<unsigned char>(word[0])) || word[0] == '-') return false;
  return std::all_of(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(equals),
                     [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.' || c == '-'; });
}

}  // namespace

std::vector<std::string> repeat_options(const std::vector<std::string>& words) {
  std::vector<std::string> out;
  std::string option;  // whose values are being read
  bool has_value = false;
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (std::find(std::begin(kRepeated), std::end(kRepeated), name) != std::end(kRepeated)) {
      option = name;
      has_value = name.size() < word.size();
    } else if (word.rfind("--", 0) == 0 || (has_value && !is_assignment(word))) {
      option.clear();
    } else if (!option.empty()) {
      if (has_value) out.push_back(option);
      has_value = true;
    }
    out.push_back(word);
  }
  return out;
}

}  // namespace impinge
