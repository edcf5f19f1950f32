#include "viewer/debugger/panel_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "viewer/controller/command.hpp"
#include "viewer/panels/debug/outliner.hpp"
#include "viewer/panels/debug/table.hpp"

namespace impinge {
namespace {

const Table& table_of(const PlacedText& word) {
  const std::vector<const Table*> all = tables();
  std::vector<std::string> names;
  for (const Table* table : all) names.emplace_back(table->name);
  return *all[find(word, "table", names)];
}

std::vector<std::string> columns_of(const Table& table) {
  std::vector<std::string> names;
  for (const TableColumn& column : table.columns) names.emplace_back(column.name);
  return names;
}

/// Words that begin with + or -.
std::vector<std::pair<std::string, bool>> parse_switches(LineWords words, const std::vector<std::string>& columns) {
  std::vector<std::pair<std::string, bool>> switches;
  for (const PlacedText& word : words) {
    if (word.text[0] != '+' && word.text[0] != '-')
      word.refuse(fmt::format("'{}'", word.text), "+COLUMN or -COLUMN is wanted", "put + or - before the name");
    switches.emplace_back(columns[find(word.part(1), "column", columns)], word.text[0] == '+');
  }
  return switches;
}

[[noreturn]] void refuse_quantity(const PlacedText& word, const std::string& text,
                                  const std::vector<std::string>& bodies) {
  std::vector<std::string> names;
  for (const BodyFigure& f : body_figures())
    if (f.function == BodyFunction::energy_from)
      names.emplace_back("energy_from(source), energy_from(source,a)");
    else if (f.in_plots())
      names.push_back(fmt::format("{}(a){}", f.name, f.bodies == 2 ? fmt::format(", {}(a,b)", f.name) : ""));
  word.refuse(fmt::format("'{}'", text),
              fmt::format("{} of bodies {}, without blanks, are wanted", fmt::join(names, ", "), some_of(bodies)),
              "mend the name");
}

/// A figure of a body or pair, or a column of stats.csv.
std::vector<std::pair<std::string, bool>> parse_plots(LineWords words, const std::vector<std::string>& figures,
                                                      const std::vector<std::string>& bodies) {
  std::vector<std::pair<std::string, bool>> switches;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string text(words[i].text.substr(words[i].text.empty() ? 0 : 1));
    const bool has_sign = words[i].text[0] == '+' || words[i].text[0] == '-';
    if (has_sign && text.find('(') != std::string::npos) {
      if (!parse_quantity(text, bodies)) refuse_quantity(words[i].part(1), text, bodies);
      switches.emplace_back(text, words[i].text[0] == '+');
      continue;
    }
    const auto one = parse_switches(words.subspan(i, 1), figures);
    switches.insert(switches.end(), one.begin(), one.end());
  }
  return switches;
}

/// panel sort [TABLE] COLUMN [down]: the table of contacts where none is named.
void parse_sort(LineWords words, PanelLine& p) {
  want(words, 3, 5, "panel sort [TABLE] COLUMN [down]");
  const bool names_table = words.size() == 5 || (words.size() == 4 && words[3].text != "down" && words[3].text != "up");
  const Table& table = names_table ? table_of(words[2]) : contacts_table();
  const LineWords rest = words.subspan(names_table ? 3 : 2);
  const std::vector<std::string> columns = columns_of(table);
  p.table = table.name;
  p.name = columns[find(rest[0], "column", columns)];
  p.on = rest.size() == 2 && find(rest[1], "direction", {"up", "down"}) == 1;
}

/// Those that are switched on stand at the end, in their order.
void switch_words(std::vector<std::string>& list, const std::vector<std::pair<std::string, bool>>& switches) {
  for (const auto& [word, on] : switches) {
    std::erase(list, word);
    if (on) list.push_back(word);
  }
}

std::vector<std::string> columns_at_first(std::string_view table) {
  std::vector<std::string> names;
  for (const Table* t : tables())
    for (const TableColumn& column : t->columns)
      if (t->name == table && column.at_first) names.emplace_back(column.name);
  return names;
}

}  // namespace

PanelLine parse_panel(const PlacedText& line, LineWords words, const ParameterSet& rows,
                      const std::vector<std::string>& figures) {
  want(words, 2, 64, "panel sort|columns|fold|unfold|plot|filter|axis|search|tab|front|trails|ghost|scroll|help ...");
  PanelLine p;
  p.verb = static_cast<PanelLine::Verb>(find(words[1], "panel command",
                                             {"sort", "fold", "unfold", "plot", "filter", "scroll", "help", "columns",
                                              "search", "tab", "front", "axis", "trails", "ghost"}));
  switch (p.verb) {
    case PanelLine::sort:
      parse_sort(words, p);
      break;
    case PanelLine::columns_of: {
      want(words, 4, 64, "panel columns TABLE +COLUMN -COLUMN ...");
      const Table& table = table_of(words[2]);
      p.table = table.name;
      p.columns = parse_switches(words.subspan(3), columns_of(table));
      break;
    }
    case PanelLine::tab:
      want(words, 3, 3, "panel tab NAME");
      p.name = outliner_tabs()[find(words[2], "tab", outliner_tabs())];
      break;
    case PanelLine::front:
      want(words, 3, 3, "panel front PANEL");
      p.name = panel_names()[find(words[2], "panel", panel_names())];
      break;
    case PanelLine::fold:
    case PanelLine::unfold: {
      want(words, 3, 3, "panel fold GROUP");
      std::vector<std::string> groups;
      for (const Parameter& row : rows.all())
        if (std::string group = row.path.substr(0, row.path.rfind('.'));
            std::find(groups.begin(), groups.end(), group) == groups.end())
          groups.push_back(std::move(group));
      p.name = groups[find(words[2], "group", groups)];
      break;
    }
    case PanelLine::plot:
      p.columns = parse_plots(words.subspan(2), figures, body_names(rows));
      break;
    case PanelLine::trails:
      want(words, 3, 3, "panel trails on|off");
      p.on = find(words[2], "word", {"off", "on"}) == 1;
      break;
    case PanelLine::ghost:
      want(words, 3, 3, "panel ghost FRAME|off");
      p.frame = words[2].text == "off" ? -1 : static_cast<int>(number(words[2], 0, 1e7, true));
      break;
    case PanelLine::axis:
      want(words, 3, 3, "panel axis log|linear");
      p.on = find(words[2], "axis", {"linear", "log"}) == 1;
      break;
    case PanelLine::filter:
    case PanelLine::search:
      p.name = rest(line, words, 2);
      break;
    case PanelLine::scroll:
      want(words, 4, 4, "panel scroll PANEL PIXELS");
      p.name = std::string(words[2].text);
      find(words[2], "panel", panel_names());
      p.pixels = static_cast<float>(number(words[3], 0, 1e7));
      break;
    case PanelLine::help:
      want(words, 3, 3, "panel help on|off");
      p.on = find(words[2], "word", {"off", "on"}) == 1;
  }
  return p;
}

void take(const PanelLine& line, PanelState& p) {
  switch (line.verb) {
    case PanelLine::sort:
      p.tables[line.table].sort = line.name, p.tables[line.table].descending = line.on;
      break;
    case PanelLine::columns_of: {
      std::vector<std::string>& columns = p.tables[line.table].columns;
      if (columns.empty()) columns = columns_at_first(line.table);
      const std::vector<std::string> before = columns;
      switch_words(columns, line.columns);
      if (columns.empty()) columns = before;  // a table without columns could not be got back by its heads
      break;
    }
    case PanelLine::trails:
      p.trails = line.on;
      break;
    case PanelLine::ghost:
      p.ghost = line.frame;
      break;
    case PanelLine::axis:
      p.log_plots = line.on;
      break;
    case PanelLine::search:
      p.search = line.name;
      break;
    case PanelLine::tab:
      p.tab = line.name;
      break;
    case PanelLine::front:
      for (const Panel& panel : panels())
        if (panel.name == line.name) p.front[std::string(room_of(panel))] = line.name;
      break;
    case PanelLine::fold:
      p.folded.insert(line.name);
      break;
    case PanelLine::unfold:
      p.folded.erase(line.name);
      break;
    case PanelLine::plot:
      switch_words(p.plots, line.columns);
      break;
    case PanelLine::filter:
      p.filter = line.name;
      break;
    case PanelLine::scroll:
      p.scroll[line.name] = line.pixels;
      p.is_selected_sought = false;  // or it was scrolled away by hand
      break;
    case PanelLine::help:
      p.help = line.on;
  }
}

}  // namespace impinge
