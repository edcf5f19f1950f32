#include "viewer/controller/expectations.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/world/figures.hpp"
#include "viewer/controller/frame_view.hpp"

namespace impinge {

void Expectations::check(int frame, const ConditionValues& values,
                         const std::function<std::filesystem::path()>& picture) {
  const auto fail = [&](const std::string& line) {
    ++failures_;
    if (report_) report_(line);
  };
  for (const Script::Expectation& expectation : script_.expectations()) {
    if (expectation.frame != frame) continue;
    const std::vector<double> found = values(expectation.condition);
    if (expectation.condition.holds(found)) continue;
    fail(fmt::format("{}: frame {}: expected {}; found {}", expectation.place, frame, expectation.condition.text(),
                     expectation.condition.describe(found, figure_names(judged_))));
  }
  for (const Script::ImageExpectation& image : script_.images()) {
    if (!pictures_ || image.frame != frame) continue;
    if (const std::string difference = picture_difference(picture(), image.file, image.tolerance); !difference.empty())
      fail(fmt::format("{}: frame {}: expected the picture {}; {}", image.place, frame, image.file.string(),
                       difference));
  }
}

bool Expectations::asks_of_bodies(int frame) const {
  return std::any_of(script_.expectations().begin(), script_.expectations().end(), [&](const auto& expectation) {
    return expectation.frame == frame && !expectation.condition.terms().empty();
  });
}

bool Expectations::needs_picture(int frame) const {
  for (const Script::ImageExpectation& image : script_.images())
    if (pictures_ && image.frame == frame) return true;
  return false;
}

void Expectations::note_unchecked(int last_frame) const {
  int count = 0;
  for (const Script::Expectation& expectation : script_.expectations()) count += expectation.frame > last_frame;
  for (const Script::ImageExpectation& image : script_.images()) count += image.frame > last_frame;
  if (count > 0 && report_)
    report_(fmt::format("note: {} expect {} after the last frame {} and {} not checked", count,
                        count == 1 ? "line lies" : "lines lie", last_frame, count == 1 ? "was" : "were"));
}

}  // namespace impinge
