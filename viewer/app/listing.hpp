// A list that a command prints: as text that is readable at 100 columns, or as JSON for programs.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace impinge {

/// One thing of a list.
struct Listed {
  std::vector<std::vector<std::string>> rows;             ///< of cells; the last of a row is wrapped
  std::vector<std::pair<std::string, std::string>> json;  ///< keys, and values as JSON
};

struct Listing {
  enum Layout : unsigned char {
    table,      ///< cells below one another
    paragraphs  ///< the first row in one line, what follows below it, indented
  };
  Layout layout = table;
  std::vector<std::string> heading;  ///< of the columns; empty: none
  std::vector<Listed> items;

  /// A thing whose keys in JSON are `keys`, all of them texts, and whose row has the same cells.
  void add(const std::vector<std::string>& keys, std::vector<std::string> cells);
  /// Leaves those that hold the word in any letters' case, in a row or in JSON.
  void keep(std::string_view word);
};

std::string listing_text(const Listing& listing, std::size_t columns = 100);
/// An array of objects, one a line.
std::string listing_json(const Listing& listing);

}  // namespace impinge
