#include "viewer/sweep/doubts.hpp"

#include <algorithm>
#include <iterator>

#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/notes/balance_note.hpp"
#include "viewer/notes/crossing_note.hpp"
#include "viewer/notes/crushed_note.hpp"
#include "viewer/notes/watchdog_note.hpp"

namespace impinge {

namespace {

constexpr std::uint64_t kMostOfOutput = std::uint64_t{1} << 30;

bool is_doubt(const std::string& line) {
  // a judge has a last line whatever it found
  if (line.starts_with("watch:")) return true;
  const std::initializer_list<std::string_view> judged = {kPassedMark, kDeepMark, kUnseenMark},
                                                noted = {kEnergyMark, kApartMark, kCrushedMark, kCrossesMark};
  const auto& marks = line.starts_with("judge:") ? judged : noted;
  return (line.starts_with("judge:") || line.starts_with("note:")) &&
         std::any_of(marks.begin(), marks.end(), [&](auto mark) { return line.find(mark) != std::string::npos; });
}

}  // namespace

std::string sweep_doubts(const std::filesystem::path& output) {
  if (!is_file(output)) return "";
  const std::string text = read_file(output, kMostOfOutput);
  std::string doubts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (!is_doubt(line)) continue;
    doubts += (doubts.empty() ? "" : " | ") + line.substr(line.find_first_not_of(' ', line.find(':') + 1));
  }
  return doubts;
}

}  // namespace impinge
