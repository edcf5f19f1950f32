// A table of a panel: a heading sorts, a row selects, columns can be chosen, and those that have no room beside the
// others are left out rather than squeezed. A table declares its columns once; commands name them as they stand there.
#pragma once

#include <limits>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {

struct TableColumn {
  enum Look { words, whole, number };
  std::string_view name;  ///< in commands
  std::string_view head;
  std::string_view unit;  ///< of a number, which has it with its prefix in every row
  Look look = number;
  int letters = 0;       ///< of words and whole numbers: that there is room for; words of two or less are marks
  bool at_first = true;  ///< whether it is seen where nobody chose
  std::string_view doc;
};

struct Table {
  std::string_view name;  ///< in commands: panel sort NAME COLUMN, panel columns NAME +COLUMN
  std::vector<TableColumn> columns;
  /// Position of a column, or of none: their number.
  std::size_t find(std::string_view column) const;
};

/// Those of all panels.
std::vector<const Table*> tables();
const Table& bodies_table();
const Table& groups_table();
const Table& pairs_table();
const Table& contacts_table();

/// What a table has where there is no number.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// What a table shows of a frame. Functions are asked only for rows in sight.
struct TableRows {
  std::vector<double> numbers;  ///< rows by columns; what it sorts by, NaN: there is none
  std::size_t count(const Table& table) const { return numbers.size() / table.columns.size(); }
  std::vector<std::size_t> shown;  ///< the rows that are listed, as the scene has them
  std::function<std::string(std::size_t row, std::size_t column)> words;  ///< of such columns
  std::function<std::string(std::size_t row)> name;                       ///< of its widgets
  std::function<std::string(std::size_t row)> select, tip;                ///< line of a click; what it hovers as
  std::function<bool(std::size_t row)> is_selected, is_dim;
  int icons = 0;  ///< squares at the row's left
  std::function<void(std::size_t row)> draw_icons = nullptr;
  /// Draws instead of words; of columns that have no text.
  std::function<void(std::size_t row, std::size_t column)> draw_mark = nullptr;
};

/// `panel`: whose widgets they are and whose scrolling it is. Returns the chosen columns that have no room.
std::vector<std::string> draw_table(Ui& ui, const DebugModel& model, CommandLines& lines, std::string_view panel,
                                    const Table& table, const TableRows& rows);

/// A list of the table's columns to switch.
void draw_column_chooser(Ui& ui, const DebugModel& model, CommandLines& lines, std::string_view panel,
                         const Table& table);

}  // namespace impinge
