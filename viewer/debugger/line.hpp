// What the debugger understands beside the commands of a script, one a line, done one after another:
//
//   set | layer | camera | hide | pull ...    as in a script, from the next frame on
//   step [N] | back [N] | seek FRAME | play | pause
//   step stage [N] | step substep [N] | back stage [N] | back substep [N]
//   break when CONDITION | break off | find CONDITION
//   why NAME NAME                       what each filter of detection made of two bodies
//   freeze FILE                         the last sub-step of the frame, for impinge step
//   export FORMAT [FOLDER]              all frames that are known, for other programs
//   undo | redo                         of set, layer, hide, pull ...: the last that was done, or undone
//   select body NAME [TRIANGLE] | select contact INDEX | select none
//   panel ...                           panel_line.hpp
//   ui click NAME | drag NAME VALUE | move X Y | press BUTTON | release BUTTON | wheel STEPS | key NAME [down|up] |
//   text WORDS | wait FRAMES
//   shot FILE.png | plots FILE.csv      the window; what the timeline plots
//   bundle FILE.tar                     the moment in one file (viewer/bundle/bundle.hpp)
//   quit
#pragma once

#include "viewer/controller/command.hpp"
#include "viewer/controller/expression.hpp"
#include "viewer/debugger/panel_line.hpp"

namespace impinge {

struct TransportLine {
  enum Verb { step, back, seek, play, pause };
  enum Unit { frame, substep, stage };
  Verb verb = step;
  int frames = 1;  ///< or sub-steps, or stages; of seek: which frame
  Unit unit = frame;
};
struct BreakLine {
  std::optional<Expression> condition;  ///< none: off
  std::string place;
};
struct FindLine {
  Expression condition;
};
struct WhyLine {
  int a = 0, b = 0;  ///< bodies
};
struct FreezeLine {
  std::string file;
};
struct ExportLine {
  std::string format, folder;
};
struct SelectLine {
  Selection selection;  ///< pair_id is not filled in
};
struct InputLine {
  enum Verb { click, drag, move, press, release, wheel, key, type, wait };
  Verb verb = click;
  std::string name;                       ///< widget, button, key or text
  double x = 0.0, y = 0.0;                ///< move; wheel: y; drag: value in x; wait: in x
  bool goes_down = true, goes_up = true;  ///< key
  bool has_clicked = false;               ///< move
};
struct FileLine {
  enum What { shot, plots, bundle };
  What what = shot;
  std::string file;
};
struct QuitLine {};
struct UndoLine {
  bool again = false;  ///< redo
};
using DebugLine = std::variant<std::vector<Command>, TransportLine, SelectLine, PanelLine, InputLine, FileLine,
                               QuitLine, UndoLine, BreakLine, FindLine, WhyLine, FreezeLine, ExportLine>;

/// What names a line may use.
struct DebugNames {
  const ParameterSet& rows;
  const StepRecord& record;                 ///< bodies; contacts of the present frame
  const std::vector<std::string>& figures;  ///< columns of stats.csv
  const ExpressionWords& conditions;        ///< what these may speak of
};

/// Throws InputError at the word that is wrong. Whether a widget is there shows when it is used.
DebugLine parse_debug_line(const PlacedText& line, const DebugNames& names);

}  // namespace impinge
