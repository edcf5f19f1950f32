// Frames that the debugger knows as files for other programs, as impinge export writes those of a run.
#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "viewer/debugger/debugger.hpp"
#include "viewer/debugger/session_scopes.hpp"
#include "viewer/export/exports.hpp"

namespace impinge {

std::string Debugger::export_frames(const std::string& format, const std::filesystem::path& folder) {
  constexpr int kEnd = 1 << 30;
  const int home = frame(), last = static_cast<int>(hashes_.size()) - 1;
  const int place = within_ ? within_->place : kEnd;
  const KeptView view(session_);
  const auto go_home = [&] {
    within_.reset();
    const InterruptScope finish(nullptr);
    restore_before(home);
    reach(home);
    if (place != kEnd) stand_in(home, place);
  };
  std::string result;
  try {
    reach(0);
    ExportJob job = session_.export_job();
    job.folder = folder;
    job.option = "export";
    job.frames = last + 1;
    Exports exports({format}, job, session_.world().record_of_all());
    int made = 0;
    for (int k = 0; k <= last && !is_interrupted(); ++k) {
      reach(k);
      if (session_.frame() != k) break;
      exports.add(session_.record());
      ++made;
      if (progress_) progress_(k, last);
    }
    exports.finish();
    for (const std::string& file : exports.results())
      result += fmt::format("{}exported: {} ({} frame{}{})", result.empty() ? "" : "; ", file, made,
                            made == 1 ? "" : "s", made <= last ? ", cut short" : "");
  } catch (const Interrupted&) {
    go_home();
    return "";
  } catch (const std::exception&) {
    go_home();
    throw;
  }
  go_home();
  return result;
}

}  // namespace impinge
