// The commands that do something to a body: pull, release, push, move, delete, add.
#pragma once

#include <span>

#include "engine/core/parameter.hpp"
#include "engine/world/step_record.hpp"
#include "viewer/controller/command.hpp"
#include "viewer/controller/text_place.hpp"

namespace impinge {

/// The words that they begin with.
const std::vector<std::string>& act_verbs();

/// Reads one, whose first word is a verb. Throws InputError at the word that is wrong.
Act parse_act(std::span<const PlacedText> words, const ParameterSet& rows);

/// Refuses, for `add`, a name that a body has or had.
void check_new_name(const PlacedText& name, const ParameterSet& rows);

/// The bodies that it changes or goes along with; how they are drawn is nobody's loss.
std::vector<std::string> acted_on(const Command& command);

/// What to say of impulses that these commands have given far off their bodies; "": nothing. `record`: of the frame that
/// shows them first.
std::string far_push_note(std::span<const Command> commands, const StepRecord& record);

/// As a line that parse_act reads back exactly.
std::string format_act(const Act& act);

}  // namespace impinge
