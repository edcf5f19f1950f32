#include "viewer/controller/expectations.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/world/figures.hpp"
#include "viewer/controller/frame_view.hpp"

namespace impinge {

namespace {

std::string in_frames(const Script::Expectation& expectation) {
  if (!expectation.is_range()) return "";
  return fmt::format(" in frames {} to {}", expectation.first, expectation.last);
}

/// `odd`: what is not finite, "" if all is; `why` that is no answer.
std::string what_was_found(const std::string& figures, const std::string& odd, const std::string& why) {
  std::string text = figures.empty() ? "" : "found " + figures;
  if (!odd.empty()) text += fmt::format("{}{}, and {}", text.empty() ? "found that " : ": ", odd, why);
  return text.empty() ? "it asks of nothing that could change" : text;
}

}  // namespace

/// Why what is not finite is none.
std::string Expectations::no_answer(int frame, const Expression& condition, const Bodies& bodies) const {
  const std::optional<MissingBody> missing = missing_body(condition, bodies);
  if (!missing) return "what is not finite is no answer";
  if (!missing->is_deleted) return fmt::format("'{}' is not there yet", missing->name);
  for (int k = 0; k <= frame; ++k)
    for (const Command& command : script_.commands_at(k))
      if (const auto* act = std::get_if<Act>(&command);
          act != nullptr && act->verb == Act::remove && act->body == missing->name)
        return fmt::format("'{}' was deleted in frame {}", missing->name, k);
  return fmt::format("'{}' is deleted", missing->name);  // by hand
}

void Expectations::check(int frame, const ConditionValues& values, const Bodies& bodies,
                         const std::function<std::filesystem::path()>& picture) {
  const auto fail = [&](const std::string& line) {
    ++failures_;
    if (report_) report_(line);
  };
  failed_.resize(script_.expectations().size());
  for (std::size_t i = 0; i < failed_.size(); ++i) {
    const Script::Expectation& expectation = script_.expectations()[i];
    if (!expectation.is_of(frame)) continue;
    failed_[i].erase(failed_[i].lower_bound(frame), failed_[i].end());  // what was made before is another future
    const std::vector<double> found = values(expectation.condition);
    std::string odd;
    const std::optional<bool> holds = expectation.condition.truth(found, odd);
    if (holds == true) continue;
    if (failed_[i].empty())
      fail(fmt::format("{}: frame {}: expected {}{}; {}", expectation.place, frame, expectation.condition.text(),
                       in_frames(expectation),
                       what_was_found(expectation.condition.describe(found, figure_names(judged_)), odd,
                                      no_answer(frame, expectation.condition, bodies))));
    failed_[i].insert(frame);
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
    return expectation.is_of(frame) && !expectation.condition.terms().empty();
  });
}

bool Expectations::needs_picture(int frame) const {
  for (const Script::ImageExpectation& image : script_.images())
    if (pictures_ && image.frame == frame) return true;
  return false;
}

void Expectations::tell_rest(int last_frame) const {
  if (!report_) return;
  int count = 0;
  for (std::size_t i = 0; i < script_.expectations().size(); ++i) {
    const Script::Expectation& expectation = script_.expectations()[i];
    count += expectation.first > last_frame;
    if (i < failed_.size() && failed_[i].size() > 1)
      report_(fmt::format("{}: expected {}{}: failed in {} of these, last in frame {}", expectation.place,
                          expectation.condition.text(), in_frames(expectation), failed_[i].size(),
                          *failed_[i].rbegin()));
    if (expectation.first <= last_frame && expectation.last > last_frame)
      report_(fmt::format("note: {}: expected in frames {} to {}, and not checked after the last frame {}",
                          expectation.place, expectation.first, expectation.last, last_frame));
  }
  for (const Script::ImageExpectation& image : script_.images()) count += image.frame > last_frame;
  if (count > 0)
    report_(fmt::format("note: {} expect {} after the last frame {} and {} not checked", count,
                        count == 1 ? "line lies" : "lines lie", last_frame, count == 1 ? "was" : "were"));
}

}  // namespace impinge
