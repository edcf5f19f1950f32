// A scene as a bundle carries it: resolved, and with copies of the files that it reads.
#pragma once

#include <map>

#include "viewer/controller/session.hpp"

namespace impinge {

/// The rows with the values that they have now, whatever becomes of theirs.
ParameterSet values_of(const ParameterSet& rows);

/// Names of the files that a scene reads become names of parts of a bundle.
class BundleFiles {
 public:
  /// Throws InputError where a file can't be read or is not what the scene was made of.
  explicit BundleFiles(const std::vector<SurfaceFile>& surfaces);
  /// The bytes by the part's name.
  const std::map<std::string, std::string>& parts() const { return parts_; }
  /// Bodies and files by the new names, none of which leads out of the folder.
  Scene renamed(Scene scene) const;

 private:
  std::string add(const SurfaceFile& file);
  void rename(TomlNode& node) const;

  std::map<std::string, std::string> parts_;
  std::map<std::filesystem::path, std::string> places_;  // part by where a surface lies
  std::map<std::string, std::string> names_;             // part by what the scene calls it
};

/// A row of stats.csv as a bundle has it: without times, so that the same moment gives the same bytes.
std::vector<double> without_times(std::vector<double> figures, bool judged);

/// Parts of a bundle: run.toml and all that it names. `start`: the rows before frame 0; `by_hand`: lines that come before
/// the script's of their frame.
std::map<std::string, std::string> bundled_scene(const Session& session, const ParameterSet& start,
                                                 const std::vector<std::string>& by_hand, int last_frame);

}  // namespace impinge
