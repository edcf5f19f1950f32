// impinge diff: two pictures, or two folders of pictures name by name.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "engine/core/error.hpp"
#include "viewer/app/commands.hpp"
#include "viewer/image/difference.hpp"
#include "viewer/image/png.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

struct Pair {
  std::string name;
  fs::path a, b;
};

// a run's folder stands for its frames
fs::path pictures_of(const fs::path& folder) { return fs::is_directory(folder / "frames") && fs::is_regular_file(folder / "run.toml") ? folder / "frames" : folder; }

std::set<std::string> pictures_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".png") names.insert(entry.path().filename().string());
  return names;
}

class Comparison {
 public:
  explicit Comparison(const Arguments& arguments) : out_(arguments.out) {
    settings_.tolerance = arguments.tolerance;
    if (!arguments.mask.empty()) mask_ = read_png(arguments.mask);
  }

  void pair(const Pair& pair) {
    ++compared_;
    const Image a = read_png(pair.a), b = read_png(pair.b);
    if (a == b) return;
    const Image* mask = mask_ ? &*mask_ : nullptr;
    if (a.width != b.width || a.height != b.height) {
      say(pair.name, fmt::format("sizes differ: {}x{} and {}x{}", a.width, a.height, b.width, b.height));
      return;
    }
    const Difference difference = compare(a, b, settings_, mask);
    if (difference.same) return;
    say(pair.name, difference.reason);
    if (out_.empty()) return;
    std::error_code error;
    fs::create_directories(out_, error);
    if (error) throw InputError(fmt::format("{}: can't be made ({}); a folder that may be written to is wanted; choose another --out", out_.string(), error.message()));
    write_png(out_ / pair.name, difference_panels(a, b, difference, mask));
  }
  void missing(const std::string& name, const std::string& where) { say(name, "missing in " + where); }

  int finish() const {
    if (different_ == 0) fmt::print("{} picture{} compared, no difference beyond the tolerance\n", compared_, compared_ == 1 ? "" : "s");
    else fmt::print("{} of {} differ{}\n", different_, std::max(compared_, different_), out_.empty() ? "" : ", shown in " + out_.string());
    return different_ == 0 ? 0 : 1;
  }

 private:
  void say(const std::string& name, const std::string& what) {
    ++different_;
    fmt::print("{}: {}\n", name, what);
  }

  fs::path out_;
  DifferenceSettings settings_;
  std::optional<Image> mask_;
  int compared_ = 0, different_ = 0;
};

void check_there(const fs::path& path) {
  if (!fs::exists(path)) throw InputError(path.string() + ": there is no such file or folder; a PNG or a folder of PNGs is wanted; check the path");
}

}  // namespace

int diff_command(const Arguments& arguments) {
  const fs::path a = arguments.a, b = arguments.b;
  check_there(a), check_there(b);
  Comparison comparison(arguments);
  if (fs::is_directory(a) != fs::is_directory(b))
    throw InputError(fmt::format("{} and {}: one is a folder, the other is not; two PNGs or two folders are wanted; name two of a kind", a.string(), b.string()));
  if (!fs::is_directory(a)) {
    comparison.pair({a.filename().string(), a, b});
    return comparison.finish();
  }
  const fs::path folder_a = pictures_of(a), folder_b = pictures_of(b);
  const std::set<std::string> in_a = pictures_in(folder_a), in_b = pictures_in(folder_b);
  std::set<std::string> names = in_a;
  names.insert(in_b.begin(), in_b.end());
  if (names.empty()) throw InputError(fmt::format("{} and {}: no PNG files in either; folders of PNGs are wanted; check the paths", folder_a.string(), folder_b.string()));
  for (const std::string& name : names) {
    if (!in_a.contains(name)) comparison.missing(name, folder_a.string());
    else if (!in_b.contains(name)) comparison.missing(name, folder_b.string());
    else comparison.pair({name, folder_a / name, folder_b / name});
  }
  return comparison.finish();
}

}  // namespace impinge
