// impinge diff
#include "viewer/app/shared_options.hpp"
#include "viewer/compare/pictures.hpp"

namespace impinge {

namespace {

class DiffCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("A", pictures_.a, "PNG file or folder: what is wanted");
    options.word("B", pictures_.b, "PNG file or folder: what there is");
    options.path("--out", pictures_.out, "folder for report.html and three-panel pictures of the differences");
    tolerance_option(options, pictures_.tolerance,
                     "largest difference of a channel, of 255, that counts as equal (default: 3)");
    options.path("--mask", pictures_.mask, "PNG: black pixels are not compared");
    options.flag("--update", pictures_.update,
                 "make A what B is where they differ beyond the limits, and say what was rewritten");
  }
  int run() override { return compare_pictures(pictures_); }

 private:
  PicturesOptions pictures_;
};

}  // namespace

Entry<SubCommand> diff_command() {
  return entry<SubCommand, DiffCommand>("diff", "compare two pictures or two folders of pictures");
}

}  // namespace impinge
