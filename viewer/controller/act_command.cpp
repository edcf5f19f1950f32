#include "viewer/controller/act_command.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/bodies/body_keys.hpp"
#include "engine/core/error.hpp"
#include "engine/core/units.hpp"
#include "engine/io/scene/scene_body.hpp"

namespace impinge {

namespace {

constexpr double kFarthest = 1e9, kMostImpulse = 1e12, kLeastStiffness = 1e-6, kMostStiffness = 1e12, kMostTurn = 36000;
constexpr double kFarOff = 0.5;  // of the diagonal of a body's box: a push farther away than that may be a mistake

struct ActRow {
  Act::Verb verb;
  const char *name, *usage;
};
constexpr ActRow kActs[] = {
    {Act::pull, "pull", "pull BODY X Y Z to X Y Z [stiffness K]"},
    {Act::release, "release", "release BODY"},
    {Act::push, "push", "push BODY JX JY JZ [at X Y Z]"},
    {Act::move, "move", "move BODY DX DY DZ [turn AX AY AZ DEGREES]"},
    {Act::remove, "delete", "delete BODY"},
    {Act::add, "add", "add NAME like BODY at X Y Z [velocity VX VY VZ] [turn AX AY AZ DEGREES]"},
};

/// The words of a line, one after another.
class WordReader {
 public:
  WordReader(std::span<const PlacedText> words, const ActRow& verb) : words_(words), verb_(verb) {}

  const PlacedText& next(const char* what) {
    if (at_ >= words_.size())
      words_[0].refuse(fmt::format("'{}' without {}", verb_.name, what), fmt::format("{} is wanted", verb_.usage),
                       "mend the line");
    return words_[at_++];
  }
  /// Whether the word is the next one; it is passed by then.
  bool take(std::string_view word) {
    const bool is_next = at_ < words_.size() && words_[at_].text == word;
    if (is_next) ++at_;
    return is_next;
  }
  /// The word, which must be the next one.
  void must(std::string_view word, const char* before) {
    const PlacedText& found = next(fmt::format("'{}' and {}", word, before).c_str());
    if (found.text != word)
      found.refuse(fmt::format("'{}'", found.text), fmt::format("{} is wanted", verb_.usage),
                   fmt::format("write {} before {}", word, before));
  }
  /// `turn AX AY AZ DEGREES`, where it is next.
  void turn(Act& act) {
    act.axis = vector(kFarthest, "an axis");
    if (act.axis.norm() == 0.0)
      last().refuse("an axis of no length", "the direction that the body turns about is wanted", "write 0 1 0");
    act.degrees = number(-kMostTurn, kMostTurn, "an angle in degrees");
  }
  double number(double low, double high, const char* what) {
    const PlacedText& word = next(what);
    Parameter row;
    row.path = verb_.name;
    row.range = {low, high};
    try {
      return std::get<double>(parse_value(row, word.text));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}; change it", word.place(), error.what()));
    }
  }
  Vec3 vector(double most, const char* what) {
    Vec3 v;
    for (int k = 0; k < 3; ++k) v[k] = number(-most, most, what);
    return v;
  }
  void end() const {
    if (at_ < words_.size())
      words_[at_].refuse(fmt::format("'{}' after all that '{}' takes", words_[at_].text, verb_.name),
                         fmt::format("{} is wanted", verb_.usage), "remove it");
  }
  const PlacedText& last() const { return words_[at_ - 1]; }

 private:
  std::span<const PlacedText> words_;
  const ActRow& verb_;
  std::size_t at_ = 1;
};

bool is_moved_by_forces(std::string_view body, const ParameterSet& rows) {
  return rows.find(fmt::format("body.{}.mass", body)) != nullptr;
}

bool is_deformable(std::string_view body, const ParameterSet& rows) {
  return rows.find(fmt::format("body.{}.material.element", body)) != nullptr;
}

/// Whether the name is free is for others to say (check_new_name): a script's own are known before it is read.
Act parse_add(WordReader& words, const ParameterSet& rows) {
  const double farthest = body_key("position").range.high, fastest = body_key("velocity").range.high;
  Act act;
  act.verb = Act::add;
  const PlacedText& name = words.next("a name");
  if (const std::string fault = fault_of_name(name.text, "a body"); !fault.empty())
    throw InputError(fmt::format("{}: {}", name.place(), fault));
  act.body = std::string(name.text);
  words.must("like", "the body that it is a copy of");
  const PlacedText& like = words.next("the body that it is a copy of");
  check_body(like, like.text, body_names(rows));
  if (!is_moved_by_forces(like.text, rows))
    like.refuse(fmt::format("a copy of '{}', which no force moves", like.text),
                "a dynamic or deformable body is wanted", "name another one");
  act.like = std::string(like.text);
  words.must("at", "its place");
  act.vector = words.vector(farthest, "the place of its file's origin, m");
  if (words.take("velocity")) act.velocity = words.vector(fastest, "a velocity, m/s");
  if (words.take("turn")) words.turn(act);
  words.end();
  return act;
}

std::string text_of(const Vec3& v) {
  return fmt::format("{} {} {}", shortest(v.x()), shortest(v.y()), shortest(v.z()));
}

std::string turn_text(const Act& act) {
  return act.axis.norm() > 0.0 ? fmt::format(" turn {} {}", text_of(act.axis), shortest(act.degrees)) : "";
}

}  // namespace

const std::vector<std::string>& act_verbs() {
  static const std::vector<std::string> verbs = [] {
    std::vector<std::string> names;
    for (const ActRow& row : kActs) names.emplace_back(row.name);
    return names;
  }();
  return verbs;
}

Act parse_act(std::span<const PlacedText> all, const ParameterSet& rows) {
  const ActRow& verb = kActs[std::find(act_verbs().begin(), act_verbs().end(), all[0].text) - act_verbs().begin()];
  WordReader words(all, verb);
  Act act;
  act.verb = verb.verb;
  if (act.verb == Act::add) return parse_add(words, rows);
  const PlacedText& body = words.next("a body");
  check_body(body, body.text, body_names(rows));
  act.body = std::string(body.text);
  if (act.verb != Act::remove && !is_moved_by_forces(body.text, rows))
    body.refuse(fmt::format("'{}' of '{}', which no force moves", verb.name, body.text),
                "a dynamic or deformable body is wanted", "name another one");
  switch (act.verb) {
    case Act::pull:
      act.point = words.vector(kFarthest, "the point of the body that is pulled");
      words.must("to", "the place");
      act.vector = words.vector(kFarthest, "the place that it is pulled to");
      if (words.take("stiffness")) act.stiffness = words.number(kLeastStiffness, kMostStiffness, "a stiffness, N/m");
      break;
    case Act::push:
      act.vector = words.vector(kMostImpulse, "an impulse, N s");
      if (words.take("at")) act.point = words.vector(kFarthest, "a place, m");
      break;
    case Act::move:
      act.vector = words.vector(kFarthest, "a way, m");
      if (!words.take("turn")) break;
      if (is_deformable(body.text, rows))
        words.last().refuse(fmt::format("'turn' of the deformable body '{}'", body.text),
                            "its nodes are moved as they are", "remove it");
      words.turn(act);
      break;
    case Act::add:
    case Act::release:
    case Act::remove:
      break;
  }
  words.end();
  return act;
}

void check_new_name(const PlacedText& name, const ParameterSet& rows) {
  const std::vector<std::string> taken = body_names(rows);
  if (std::find(taken.begin(), taken.end(), name.text) != taken.end())
    name.refuse(fmt::format("a second body named '{}'", name.text), "names must differ, also from deleted ones",
                "choose another");
}

std::string far_push_note(std::span<const Command> commands, const StepRecord& record) {
  std::string note;
  for (const Command& command : commands) {
    const auto* act = std::get_if<Act>(&command);
    if (act == nullptr || act->verb != Act::push || !act->point) continue;
    for (const BodyRecord& body : record.bodies) {
      if (body.name != act->body || body.deleted || body.bounds.is_empty()) continue;
      const Vec3 nearest = act->point->cwiseMax(body.bounds.min).cwiseMin(body.bounds.max);
      const double away = (*act->point - nearest).norm();
      // between the push and the end of the frame it has moved
      const double size = body.bounds.extent().norm(), moved = body.velocity.norm() * record.frame_time;
      if (!(away > kFarOff * size + moved)) continue;
      note += fmt::format("{}'{}' was pushed at {}, {} away from it: {}", note.empty() ? "" : "; ", body.name,
                          text_of(*act->point), length_text(away),
                          body.deformable != nullptr ? "its nearest point had the impulse"
                                                     : "it is turned as by a lever of that length");
    }
  }
  return note;
}

std::vector<std::string> acted_on(const Command& command) {
  if (const auto* act = std::get_if<Act>(&command)) return {act->body};
  if (const auto* bodies = std::get_if<BodiesCommand>(&command))
    return bodies->verb == BodiesCommand::follow || bodies->verb == BodiesCommand::frame ? bodies->names
                                                                                         : std::vector<std::string>();
  constexpr std::string_view kBody = "body.";
  const auto* set = std::get_if<SetCommand>(&command);
  if (set == nullptr || !set->path.starts_with(kBody)) return {};
  return {set->path.substr(kBody.size(), set->path.find('.', kBody.size()) - kBody.size())};
}

std::string format_act(const Act& act) {
  std::string line;
  for (const ActRow& row : kActs)
    if (row.verb == act.verb) line = fmt::format("{} {}", row.name, act.body);
  switch (act.verb) {
    case Act::pull:
      line += fmt::format(" {} to {}", text_of(*act.point), text_of(act.vector));
      if (act.stiffness > 0.0) line += " stiffness " + shortest(act.stiffness);
      break;
    case Act::push:
      line += " " + text_of(act.vector);
      if (act.point) line += " at " + text_of(*act.point);
      break;
    case Act::move:
      line += " " + text_of(act.vector);
      line += turn_text(act);
      break;
    case Act::add:
      line += fmt::format(" like {} at {}", act.like, text_of(act.vector));
      if (act.velocity != Vec3::Zero()) line += " velocity " + text_of(act.velocity);
      line += turn_text(act);
      break;
    case Act::release:
    case Act::remove:
      break;
  }
  return line;
}

}  // namespace impinge
