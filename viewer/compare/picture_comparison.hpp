// Two picture files compared the way a person would tell about it: same or not, by which rule, where, since when it
// differs in what, and to what the changed pixels belong.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "viewer/image/change_kind.hpp"
#include "viewer/image/difference.hpp"
#include "viewer/image/object_changes.hpp"
#include "viewer/image/picture_facts.hpp"

namespace impinge {

struct PictureComparison {
  enum Verdict { same, different, sizes, missing_in_a, missing_in_b };
  std::string name;
  std::filesystem::path a, b;  ///< the missing one "" where one is missing
  Verdict verdict = same;
  Difference difference;  ///< of same and different
  double flip = 0.0;      ///< mean LDR-FLIP of a different one
  ChangeKind kind;
  PictureFacts facts_a, facts_b;
  ChangeCause cause = ChangeCause::unknown;
  bool has_ids = false;
  std::vector<ObjectChange> objects;  ///< the most pixels first
  std::string headline;               ///< one line; "" for the same
  std::vector<std::string> details;   ///< lines below it
};

struct PictureRules {
  DifferenceSettings settings;
  const Image* mask = nullptr;
};

/// Reads both and says whether they are the same: verdict, difference and headline.
PictureComparison judge_pictures(const std::string& name, const std::filesystem::path& a,
                                 const std::filesystem::path& b, const PictureRules& rules);
/// All the rest of a pair that is judged different, which takes a hundred times as long.
void explain_difference(PictureComparison& different, const PictureRules& rules);

/// Both of these; id pictures beside them (frames/X.png with ids/X.png, or X.png with ids/X.png in the
/// same folder) are used where both have them. Throws InputError where a file is missing or no PNG.
PictureComparison compare_pictures(const std::string& name, const std::filesystem::path& a,
                                   const std::filesystem::path& b, const PictureRules& rules);

/// Where the id picture of a picture would be.
std::filesystem::path id_picture_of(const std::filesystem::path& picture);

/// Of a baseline X.png and its alternates X@RENDERER.png: the one made by the renderer of `picture`, else X.png itself.
std::filesystem::path baseline_for(const std::filesystem::path& baseline, const std::filesystem::path& picture);
/// X@RENDERER.png for the renderer that made `picture`; `baseline` itself where the picture doesn't say.
std::filesystem::path alternate_for(const std::filesystem::path& baseline, const std::filesystem::path& picture);
bool is_alternate(const std::string& file_name);

/// Makes `baseline` a copy of `picture`: or its alternate, where only the renderer changed. Its id picture is copied
/// into the folder ids beside it; one that was there is removed where `picture` has none, for it would tell of the
/// picture before. Returns the file written. Throws InputError.
std::filesystem::path update_baseline(const PictureComparison& comparison, const std::filesystem::path& baseline,
                                      const std::filesystem::path& picture);

/// Of two pictures that are the same within the limits: copies the id picture of B beside A where A has none, or one
/// that names other objects (a body that was given another name, say). Returns the file written, "" if none was. Throws
/// InputError.
std::filesystem::path update_ids(const PictureComparison& same);

/// Into `out` (made if need be): the three-panel picture of each that differs, and report.html. `failures`: what failed
/// beside pictures, a line each. Throws InputError where that can't be written; then nothing of it is left.
void write_picture_report(const std::filesystem::path& out, const std::string& title,
                          const std::vector<PictureComparison>& pictures, const PictureRules& rules,
                          const std::vector<std::string>& failures = {});

}  // namespace impinge
