// A caption with characters that the letters of pictures don't have.
#include <fmt/format.h>

#include "viewer/image/label.hpp"
#include "viewer/preflight/view_warning.hpp"

namespace impinge {
namespace {

class MissingLetters : public ViewWarning {
 public:
  std::vector<Finding> look(const ViewAtStart& start) const override {
    const std::string missing = missing_letters(start.settings.caption);
    if (missing.empty()) return {};
    return {{fmt::format("view.caption.text has '{}', for which there are no letters: pictures show '?'", missing),
             "write it with others: Latin, Greek and Cyrillic ones are there"}};
  }
};

}  // namespace

Entry<ViewWarning> missing_letters_warning() {
  return entry<ViewWarning, MissingLetters>("missing-letters", "a caption has characters that pictures show as '?'");
}

}  // namespace impinge
