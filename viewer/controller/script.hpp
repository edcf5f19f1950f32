// A script: commands with the frames at which they take effect, and what is expected. Everything in it, names and
// values included, is checked when it is read, before frame 0.
//
//   at K COMMAND
//   from A to B ramp PATH VALUE VALUE            linear, A and B inclusive
//   expect CONDITION at K
//   expect CONDITION from A to B                 in every frame of them, A and B inclusive
//   expect image FILE [tolerance N] at K
//   break when CONDITION
//   # comment
#pragma once

#include <filesystem>

#include "viewer/controller/command.hpp"
#include "viewer/controller/expression.hpp"

namespace impinge {

class Script {
 public:
  struct Expectation {
    int first = 0, last = 0;  ///< frames in which it must hold
    Expression condition;
    std::string place;
    bool is_of(int frame) const { return first <= frame && frame <= last; }
    bool is_range() const { return first < last; }
  };
  struct ImageExpectation {
    int frame = 0;
    std::filesystem::path file;
    int tolerance = 3;  ///< of 255, largest difference of a channel that counts as equal
    std::string place;
  };
  struct Break {
    Expression condition;
    std::string place;
  };

  Script() = default;
  /// `words` are those of conditions. `name` is the file's in messages, `folder` what image paths are relative to. Throws InputError `file:line:column`.
  Script(const std::string& name, const std::filesystem::path& folder, const std::vector<std::string>& lines,
         const ParameterSet& rows, const ExpressionWords& words, bool pictures_may_be_missing = false);
  Script(const std::string& name, const std::filesystem::path& folder, const std::vector<std::string>& lines,
         const ParameterSet& rows, const std::vector<std::string>& figures, bool pictures_may_be_missing = false)
      : Script(name, folder, lines, rows, ExpressionWords{figures, {}, {}, "", false, {}}, pictures_may_be_missing) {}

  /// What takes effect with the frame, in the order of the lines; ramps as `set`.
  std::vector<Command> commands_at(int frame) const;
  /// What each of its lines does, in their order; of a ramp the parameter without a value.
  std::vector<const Command*> commands() const;
  /// Refuses lines that act on a body which another one has deleted by then, or adds only later: nothing in a script
  /// depends on how a run goes, so these do nothing for certain.
  void check_bodies_are_there() const;
  int last_frame() const { return last_frame_; }  ///< the largest frame named, -1 for none

  /// Former paths of parameters that its lines name.
  const std::vector<std::string>& former_paths() const { return former_paths_; }

  const std::vector<Expectation>& expectations() const { return expectations_; }
  const std::vector<ImageExpectation>& images() const { return images_; }
  const std::vector<Break>& breaks() const { return breaks_; }

 private:
  struct Timed {
    int first = 0, last = 0;
    Command command;  // of `at`; the ramp's end otherwise
    bool ramp = false;
    ParameterValue from, to;
    int line = 0;
    std::string place = {};  // of what it is about
  };
  void read_line(const PlacedText& line, const std::filesystem::path& folder, const ParameterSet& rows,
                 const ExpressionWords& conditions);
  void read_ramp(std::span<const PlacedText> words, const ParameterSet& rows);
  void read_expect(const PlacedText& line, std::span<const PlacedText> words, const std::filesystem::path& folder,
                   const ExpressionWords& conditions);
  int read_frame(const PlacedText& word);
  std::pair<int, int> read_frames(const PlacedText& first, const PlacedText& last, const char* what);

  std::vector<Timed> timed_;
  std::vector<Expectation> expectations_;
  std::vector<ImageExpectation> images_;
  std::vector<Break> breaks_;
  std::vector<std::string> former_paths_;
  int last_frame_ = -1;
  bool pictures_may_be_missing_ = false;
};

/// The line up to a # that is in no quotes.
std::string_view without_comment(std::string_view line);

/// The lines of a script file, of "-" those of standard input. Throws InputError.
std::vector<std::string> read_lines(const std::filesystem::path& path);

}  // namespace impinge
