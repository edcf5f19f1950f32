#include "viewer/export/exports.hpp"

#include <fmt/format.h>

#include "engine/core/interrupt.hpp"
#include "engine/core/parameter.hpp"
#include "engine/io/paths.hpp"

namespace impinge {

Exports::Exports(const std::vector<std::string>& formats, const ExportJob& job, const StepRecord& start)
    : folder_(job.folder) {
  for (const std::string& format : formats) {
    ExportJob own = job;
    own.option += " " + format;
    exporters_.push_back(find_exporter(format, job.option).make());
    exporters_.back()->begin(own, start);
  }
}

void Exports::add(const StepRecord& record) {
  if (!has_folder_ && !is_empty()) make_folder(folder_);
  has_folder_ = true;
  const InterruptScope whole(nullptr);  // a frame goes to all of them or to none
  for (const auto& exporter : exporters_) exporter->add(record);
}

void Exports::finish() {
  if (!has_folder_) return;
  for (const auto& exporter : exporters_) exporter->finish();
}

std::vector<std::string> Exports::results() const {
  std::vector<std::string> all;
  for (const auto& exporter : exporters_)
    if (std::string result = exporter->result(); !result.empty()) all.push_back(std::move(result));
  return all;
}

std::string export_formats_doc() {
  std::string text;
  for (const Entry<Exporter>& e : exporters()) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", e.name, e.doc);
  return text;
}

const Entry<Exporter>& find_exporter(const std::string& name, const std::string& option) {
  if (const Entry<Exporter>* found = find_entry(exporters(), name)) return *found;
  std::vector<std::string> names;
  for (const Entry<Exporter>& e : exporters()) names.emplace_back(e.name);
  if (option == "--export") names.insert(names.begin() + 1, "sequence");  // which is ply's name there
  if (name == "sequence")
    throw InputError(
        fmt::format("command line: {} is '{}', the name that run --export has for ply; one of {} is "
                    "wanted; write {} ply",
                    option, name, some_of(names), option));
  const std::string near = nearest_word(name, names);
  throw InputError(fmt::format("command line: {} is '{}'; one of {} is wanted; {}", option, name, some_of(names),
                               near.empty() ? "choose one of them" : fmt::format("did you mean '{}'?", near)));
}

}  // namespace impinge
