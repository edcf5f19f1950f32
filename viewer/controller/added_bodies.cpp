#include "viewer/controller/added_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "engine/core/error.hpp"
#include "engine/core/units.hpp"
#include "engine/io/scene/scene_copies.hpp"
#include "viewer/controller/act_command.hpp"
#include "viewer/controller/script.hpp"

namespace impinge {
namespace {

constexpr double kHarmless = 1e-3;  // of the body's longest edge: what recovery takes back unnoticed

struct AddLine {
  int frame = 0;
  std::vector<PlacedText> words;  // from the verb on
};

/// Lines `at K add ...` in the order in which they act.
std::vector<AddLine> add_lines(const std::string& name, const std::vector<std::string>& lines) {
  std::vector<AddLine> found;
  int number = 0;
  for (const std::string& line : lines) {
    const std::vector<PlacedText> words = split_words({without_comment(line), &name, ++number, 1});
    if (words.size() < 3 || words[0].text != "at" || words[2].text != "add") continue;
    AddLine add;
    const std::string_view frame = words[1].text;
    if (std::from_chars(frame.data(), frame.data() + frame.size(), add.frame).ec != std::errc()) continue;
    add.words.assign(words.begin() + 2, words.end());
    found.push_back(std::move(add));
  }
  std::stable_sort(found.begin(), found.end(), [](const AddLine& l, const AddLine& r) { return l.frame < r.frame; });
  return found;
}

}  // namespace

void AddedBodies::read(const std::string& name, const std::vector<std::string>& lines, const Scene& scene, World& world,
                       ParameterSet& rows) {
  for (const AddLine& line : add_lines(name, lines)) {
    Addition addition{line.frame, parse_act(line.words, rows), line.words[3].place()};
    check_new_name(line.words[1], rows);
    add(addition, scene, world, rows);
    of_script_.push_back(std::move(addition));
  }
}

bool AddedBodies::list(std::vector<Addition> by_hand, const Scene& scene, World& world, ParameterSet& rows) {
  std::vector<Addition> all = std::move(by_hand);
  all.insert(all.end(), of_script_.begin(), of_script_.end());
  std::stable_sort(all.begin(), all.end(), [](const Addition& l, const Addition& r) { return l.frame < r.frame; });
  std::size_t same = 0;
  while (same < acts_.size() && same < all.size() && format_act(acts_[same]) == format_act(all[same].act)) ++same;
  if (same == acts_.size() && same == all.size()) return false;
  for (; acts_.size() > same; acts_.pop_back(), first_rows_.pop_back()) {
    world.remove_absent_body();
    rows.cut(first_rows_.back());
  }
  for (std::size_t i = same; i < all.size(); ++i) add(all[i], scene, world, rows);
  return true;
}

void AddedBodies::check(const Act& act, const Scene& scene) const { describe_added(scene, acts_, act); }

void AddedBodies::add(const Addition& addition, const Scene& scene, World& world, ParameterSet& rows) {
  const std::size_t first = rows.all().size();
  try {
    world.bind_body(rows, world.add_absent_body(describe_added(scene, acts_, addition.act)));
  } catch (const InputError& error) {
    if (addition.place.empty()) throw;
    throw InputError(fmt::format("{}: {}", addition.place, error.what()));
  }
  acts_.push_back(addition.act);
  first_rows_.push_back(first);
}

std::string overlap_note(std::span<const Command> commands, const StepRecord& record) {
  std::string note;
  for (const Command& command : commands) {
    const auto* act = std::get_if<Act>(&command);
    if (act == nullptr || act->verb != Act::add) continue;
    std::map<std::string_view, double> depths;  // by the other body
    for (const ContactRecord& c : record.contacts) {
      const BodyRecord &a = record.bodies[c.body_a], &b = record.bodies[c.body_b];
      if (c.body_a == c.body_b || (a.name != act->body && b.name != act->body)) continue;
      const BodyRecord &own = a.name == act->body ? a : b, &other = a.name == act->body ? b : a;
      const double depth = -std::min(c.gap, c.gap0);
      if (depth > kHarmless * own.bounds.extent().maxCoeff()) depths[other.name] = std::max(depths[other.name], depth);
    }
    for (const auto& [other, depth] : depths)
      note += fmt::format("{}'{}' was added {} into '{}': they are pushed apart as response and push-out allow",
                          note.empty() ? "" : "; ", act->body, length_text(depth), other);
  }
  return note;
}

std::size_t AddedBodies::rows_present(const Bodies& bodies, const ParameterSet& rows) const {
  for (std::size_t i = 0; i < acts_.size(); ++i)
    if (bodies[bodies.find(acts_[i].body)].absent) return first_rows_[i];
  return rows.all().size();
}

}  // namespace impinge
