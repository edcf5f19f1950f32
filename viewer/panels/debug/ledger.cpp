// The books of energy and momentum: what each source did in this frame and since the start, to the selected body or to
// all, what is left open, and what rose most and where.
#include <fmt/format.h>

#include <cmath>

#include "viewer/draw/number_text.hpp"
#include "viewer/panels/debug/outliner.hpp"

namespace impinge {
namespace {

constexpr double kRounding = 1e-12;  // of the turnover since the start: less is shown as nothing

void number(double value, double rounding = 0.0) {
  ImGui::TableNextColumn();
  if (std::abs(value) <= rounding)
    ImGui::TextColored(dim(), "0");
  else
    ImGui::TextUnformatted(number_text(value, "J").whole().c_str());
}

/// Of a source in words, with its momentum: what the pointer over a row shows.
std::string about_source(const LedgerSourceInfo& info, const LedgerEntry& now) {
  return fmt::format("{}{}\nin this frame: momentum {}\nangular momentum about the origin {}", info.doc,
                     info.is_exchange ? "\nIt makes no energy: the other books lose as much." : "",
                     vector_text(now.momentum, "N s"), vector_text(now.angular_momentum, "N m s"));
}

struct Books {
  const BodyLedger now, sum;
};

void source_rows(Ui& ui, const Books& books, double rounding) {
  for (const LedgerSourceInfo& info : ledger_sources()) {
    const double now = books.now.figure(info.source), sum = books.sum.figure(info.source);
    const LedgerEntry& entry = books.sum[info.source];
    if (std::abs(entry.motion) + std::abs(entry.stored) <= rounding && std::abs(now) <= rounding) continue;
    ImGui::TableNextColumn();
    ImGui::TextColored(info.is_exchange ? dim() : ImGui::GetStyleColorVec4(ImGuiCol_Text), "%s",
                       std::string(info.name).c_str());
    ui.name(fmt::format("ledger/{}", info.name));
    tooltip(about_source(info, books.now[info.source]));
    number(now, rounding);
    number(sum, rounding);
  }
}

void measured_row(const char* name, double now, double sum, double rounding, const char* doc) {
  ImGui::TableNextColumn();
  ImGui::TextColored({0.55f, 0.78f, 0.95f, 1.0f}, "%s", name);
  tooltip(doc);
  number(now, rounding);
  number(sum, rounding);
}

void draw_rise(Ui& ui, const DebugModel& model, const FrameLedger& ledger, double rounding, CommandLines& lines) {
  const std::optional<LargestRise> rise = largest_rise(ledger);
  if (!rise || rise->energy <= rounding) {
    ImGui::TextColored(dim(), "nothing rose in this frame");
    return;
  }
  const std::string body(model.record->bodies[rise->body].name);
  const std::string text =
      fmt::format("most: {} of {}, {}{}", info_of(rise->source).name, body, number_text(rise->energy, "J").whole(),
                  rise->substep > 0 ? fmt::format(", sub-step {}", rise->substep) : ", between frames");
  ImGui::TextWrapped("%s", text.c_str());
  ui.name("ledger/most");
  if (ImGui::IsItemClicked()) lines.push_back(fmt::format("select body {}", body));
  tooltip(
      "what raised the energy most in this frame, of all bodies, and in which sub-step it did most; a click selects "
      "the body");
}

void draw_ledger(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const Parameter* row = model.rows->find("record.ledger");
  bool keeps = row != nullptr && format_value(row->get()) == "true";
  const FrameLedger* ledger = model.tracks == nullptr ? nullptr : model.tracks->ledger(model.frame);
  const bool is_body = model.selection.kind == Selection::body && model.selection.is_there();
  if (ImGui::Checkbox("keep", &keeps)) lines.push_back(fmt::format("set record.ledger {}", keeps ? "true" : "false"));
  ui.name("ledger/keep");
  tooltip("whether books are kept of the frames that are made from now on (record.ledger); states are the same");
  ImGui::SameLine();
  const auto index = static_cast<std::size_t>(std::max(0, model.selection.index));
  ImGui::TextColored(dim(), "%s", is_body ? std::string(model.record->bodies[index].name).c_str() : "all bodies");
  if (ledger == nullptr) {
    ImGui::TextColored(dim(), "%s", model.frame == 0 ? "frame 0 was not made by a step" : "none of this frame");
    return;
  }
  const Tracks::LedgerSum& sum = model.tracks->ledger_sum(model.frame);
  const Books books =
      is_body ? Books{ledger->bodies[index], sum.books.bodies[index]} : Books{ledger->world(), sum.books.world()};
  const double rounding = kRounding * books.sum.turnover();
  draw_rise(ui, model, *ledger, rounding, lines);
  if (!ImGui::BeginTable("ledger", 3, ImGuiTableFlags_SizingStretchProp)) return;
  ImGui::TableSetupColumn("source", ImGuiTableColumnFlags_WidthStretch, 1.0f);
  ImGui::TableSetupColumn("this frame", ImGuiTableColumnFlags_WidthStretch, 1.0f);
  ImGui::TableSetupColumn(sum.frames == model.frame ? "since start" : fmt::format("{} frames", sum.frames).c_str(),
                          ImGuiTableColumnFlags_WidthStretch, 1.0f);
  ImGui::TableHeadersRow();
  source_rows(ui, books, rounding);
  const Balance &now = books.now.rise, &all = books.sum.rise;
  measured_row("kinetic", now.kinetic, all.kinetic, rounding, "measured: its rise");
  measured_row("potential", now.potential, all.potential, rounding, "measured: the rise of -m g x");
  if (std::abs(all.elastic) > rounding)
    measured_row("elastic energy", now.elastic, all.elastic, rounding, "measured: its rise");
  measured_row("left open", books.now.closing_error(), books.sum.closing_error(), 0.0,
               "what was measured less what the sources explain: rounding");
  ImGui::EndTable();
}

}  // namespace

Panel ledger_panel() {
  Panel panel{"ledger", "ledger", PanelPlace::right, {}, draw_ledger};
  panel.shares = "contacts";
  return panel;
}

}  // namespace impinge
