#include "viewer/preflight/preflight.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/rows.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostOfACode = 5;

void check_codes(const std::vector<std::string>& codes) {
  std::vector<std::string> names;
  for (const WarningName& warning : warning_names()) names.emplace_back(warning.code);
  for (const std::string& code : codes) {
    if (std::find(names.begin(), names.end(), code) != names.end()) continue;
    const std::string near = nearest_word(code, names);
    throw InputError(
        fmt::format("check.silence names '{}', which is no warning; allowed: {}; {}", code, fmt::join(names, ", "),
                    near.empty() ? "see `impinge list warnings`" : fmt::format("did you mean '{}'?", near)));
  }
}

}  // namespace

std::vector<WarningName> warning_names() {
  std::vector<WarningName> names;
  for (const Entry<Warning>& entry : warnings()) names.push_back({entry.name, entry.doc});
  for (const Entry<ViewWarning>& entry : view_warnings()) names.push_back({entry.name, entry.doc});
  return names;
}

void bind_silence(ParameterSet& rows, std::vector<std::string>& silenced) {
  Parameter row;
  row.path = "silence";
  row.kind = ParameterKind::text_list;
  for (const WarningName& warning : warning_names()) row.names.emplace_back(warning.code);
  row.doc = "Codes of warnings that impinge check and info don't tell of this scene; see impinge list warnings.";
  row.initial = silenced;
  row.live = false;
  row.get = [&silenced] { return ParameterValue(silenced); };
  row.set = [&silenced](const ParameterValue& value) {
    const auto& codes = std::get<std::vector<std::string>>(value);
    check_codes(codes);
    silenced = codes;
  };
  Rows(rows, "check").add(std::move(row));
}

std::size_t Preflight::count() const {
  std::size_t sum = 0;
  for (const Warned& warned : told) sum += warned.findings.size();
  return sum;
}

Preflight preflight(const SceneAtStart& scene, const ViewAtStart& view, const std::vector<std::string>& silenced) {
  Preflight result;
  const auto take = [&](std::string_view code, std::vector<Finding> findings) {
    if (findings.empty()) return;
    if (std::find(silenced.begin(), silenced.end(), code) != silenced.end())
      result.silenced += findings.size();
    else
      result.told.push_back({code, std::move(findings)});
  };
  for (const Entry<Warning>& entry : warnings()) take(entry.name, entry.make()->look(scene));
  for (const Entry<ViewWarning>& entry : view_warnings()) take(entry.name, entry.make()->look(view));
  return result;
}

std::string warning_lines(const Preflight& preflight) {
  std::string text;
  for (const Warned& warned : preflight.told) {
    const std::size_t shown = std::min(warned.findings.size(), kMostOfACode);
    for (std::size_t i = 0; i < shown; ++i)
      text += fmt::format("warning: {}: {}: {}\n", warned.code, warned.findings[i].text, warned.findings[i].remedy);
    if (warned.findings.size() > shown)
      text += fmt::format("warning: {}: and {} more\n", warned.code, warned.findings.size() - shown);
  }
  return text;
}

}  // namespace impinge
