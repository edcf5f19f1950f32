// One or several formats that the same frames go to.
#pragma once

#include "viewer/export/exporter.hpp"

namespace impinge {

class Exports {
 public:
  Exports() = default;
  /// Nothing is written yet. Throws InputError where a format cannot take the job, or is none.
  Exports(const std::vector<std::string>& formats, const ExportJob& job, const StepRecord& start);

  bool is_empty() const { return exporters_.empty(); }
  void add(const StepRecord& record);
  void finish();
  /// What there is to open, one a format.
  std::vector<std::string> results() const;

 private:
  std::filesystem::path folder_;
  std::vector<std::unique_ptr<Exporter>> exporters_;
  bool has_folder_ = false;
};

/// The formats' names, and what they are, for --help.
std::string export_formats_doc();
/// The format of that name; throws InputError, `option` being what named it.
const Entry<Exporter>& find_exporter(const std::string& name, const std::string& option);

}  // namespace impinge
