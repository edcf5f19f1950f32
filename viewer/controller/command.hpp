// The commands that change something between frames; one grammar for script files, logs and consoles.
//
//   set PATH VALUE...                           any parameter that may change while running
//   layer +NAME -NAME ...                       debug layers on and off
//   camera eye X Y Z | target X Y Z | orbit YAW PITCH | pan X Y | zoom FACTOR | fov DEGREES | fit
//   hide NAME... | isolate NAME... | show NAME...|all       bodies that are drawn; isolate: these and no others
//   lock NAME... | unlock NAME...|all                       bodies that a click goes through
//   color NAME... RRGGBB|none                               of their surfaces; none: the palette's
//   frame NAME...                                           the camera looks at them, near enough to fill the view
//   follow NAME|none                                        the camera goes along with a body
//   pull BODY X Y Z to X Y Z [stiffness K] | release BODY   a spring from a point of it to a place
//   push BODY JX JY JZ [at X Y Z]                           an impulse
//   move BODY DX DY DZ [turn AX AY AZ DEGREES]              puts it elsewhere
//   delete BODY                                             it takes no part any more
//   add NAME like BODY at X Y Z [velocity VX VY VZ] [turn AX AY AZ DEGREES]     a copy of a body
#pragma once

#include <optional>
#include <span>
#include <variant>

#include "engine/core/parameter.hpp"
#include "engine/step/act.hpp"
#include "viewer/controller/text_place.hpp"
#include "viewer/draw/palette.hpp"

namespace impinge {

struct SetCommand {
  std::string path;
  ParameterValue value;
  std::string place = {};  ///< where it stands, "" for one that nobody wrote
};
struct LayerCommand {
  std::vector<std::pair<std::string, bool>> changes;  ///< name, on
};
struct CameraCommand {
  enum Verb { eye, target, orbit, pan, zoom, fov, fit };
  Verb verb = eye;
  Vec3 value = Vec3::Zero();  ///< as many numbers as the verb has, the rest 0; angles in degrees
};
struct BodiesCommand {
  enum Verb { hide, isolate, show, lock, unlock, frame, follow, color };
  Verb verb = hide;
  std::vector<std::string> names;  ///< none: all; of follow: no body
  std::optional<Color> rgb = {};   ///< of color; none: the palette's
};
using Command = std::variant<SetCommand, LayerCommand, CameraCommand, BodiesCommand, Act>;

/// The words that commands begin with.
const std::vector<std::string>& command_verbs();
/// First words of lines that only a debugger has, for whoever finds one in a run's script: step, back, seek, play and
/// pause first.
const std::vector<std::string>& debugger_verbs();
bool is_debugger_verb(std::string_view word);
/// The bodies' names: those that have rows.
std::vector<std::string> body_names(const ParameterSet& rows);

/// Refuses at the word a name that no body has.
void check_body(const PlacedText& word, std::string_view name, const std::vector<std::string>& bodies);

/// Reads a command from the words of a line and checks every name and value against the rows: one, but for a former path
/// that stands for several parameters. Throws InputError at the word that is wrong. `first_frame`: the command takes
/// effect with frame 0, when every parameter may still be set.
std::vector<Command> parse_command(std::span<const PlacedText> words, const ParameterSet& rows, bool first_frame);

/// The command as a line that parse_command reads back exactly.
std::string format_command(const Command& command);

/// The row of a parameter that a script names, or an error at the word with the nearest name. Several for a former path
/// that stands for them.
std::vector<const Parameter*> find_rows(const PlacedText& word, const ParameterSet& rows, bool first_frame);

}  // namespace impinge
