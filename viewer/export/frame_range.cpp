#include "viewer/export/frame_range.hpp"

#include <fmt/format.h>

#include <charconv>

#include "engine/core/error.hpp"

namespace impinge {

namespace {

constexpr int kMost = 100'000'000;

}  // namespace

FrameRange::FrameRange(const std::string& text, const std::string& option) : text_(text), option_(option) {
  const auto refuse = [&](const std::string& allowed) {
    throw InputError(fmt::format("command line: {} is '{}'; {}; write {} 0:120:2, say", option, text, allowed, option));
  };
  std::vector<std::string> words = {""};
  for (const char c : text) c == ':' ? void(words.emplace_back()) : void(words.back() += c);
  if (words.size() > 3 || text.empty()) refuse("a frame, or FIRST:LAST or FIRST:LAST:STEP, is wanted");
  const auto number = [&](const std::string& word, int low) -> std::optional<int> {
    if (word.empty()) return std::nullopt;
    int value = -1;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < low || value > kMost)
      refuse(fmt::format("'{}' in it is no whole number in [{}, {}]", word, low, kMost));
    return value;
  };
  first_ = number(words[0], 0);
  last_ = words.size() == 1 ? first_ : number(words[1], 0);
  if (words.size() == 3) stride_ = number(words[2], 1).value_or(1);
  if (first_ && last_ && *first_ > *last_) refuse("its first frame is after its last, and they come in order");
}

std::vector<int> FrameRange::frames(int last) const {
  const int from = first_.value_or(0), to = last_.value_or(last);
  if (from > last || to > last)
    throw InputError(
        fmt::format("command line: {} is '{}'; the run has frames 0 to {}; choose among them, or run it on by --resume",
                    option_, text_, last));
  std::vector<int> all;
  for (int frame = from; frame <= to; frame += stride_) all.push_back(frame);
  return all;
}

}  // namespace impinge
