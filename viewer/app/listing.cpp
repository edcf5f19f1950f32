#include "viewer/app/listing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "viewer/report/parts.hpp"

namespace impinge {
namespace {

constexpr std::size_t kBetween = 2, kIndent = 4, kNarrowest = 24;

// characters, not bytes: units hold some beyond ASCII
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// Words of `text` from column `at` on, in lines that begin at column `indent` and end before `columns`.
std::string wrapped(std::string_view text, std::size_t at, std::size_t indent, std::size_t columns) {
  std::string lines;
  bool is_first = true;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    if (!is_first && at + 1 + width(word) > columns) {
      lines += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (!is_first) {
      lines += " ";
      ++at;
    }
    lines += word;
    at += width(word);
    is_first = false;
    begin = end + 1;
  }
  return lines;
}

std::string table_text(const Listing& listing, std::size_t columns) {
  std::vector<std::vector<std::string>> rows;
  if (!listing.heading.empty()) rows.push_back(listing.heading);
  for (const Listed& item : listing.items) rows.insert(rows.end(), item.rows.begin(), item.rows.end());
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::size_t last = 0;  // where the last column begins
  for (std::size_t i = 0; i + 1 < widths.size(); ++i) last += widths[i] + kBetween;
  const std::size_t to = std::max(columns, last + kNarrowest);
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i + 1 < row.size(); ++i)
      line += row[i] + std::string(widths[i] - width(row[i]) + kBetween, ' ');
    line += wrapped(row.back(), width(line), row.size() == widths.size() ? last : width(line), to);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string paragraphs_text(const Listing& listing, std::size_t columns) {
  std::string text;
  if (!listing.heading.empty()) text += fmt::format("{}\n", fmt::join(listing.heading, "  "));
  for (const Listed& item : listing.items) {
    for (std::size_t i = 0; i < item.rows.size(); ++i) {
      const std::string cells = fmt::format("{}", fmt::join(item.rows[i], "  "));
      text += i == 0 ? wrapped(cells, 0, kIndent, columns)
                     : std::string(kIndent, ' ') + wrapped(cells, kIndent, kIndent, columns);
      text += "\n";
    }
  }
  return text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return lower;
}

}  // namespace

void Listing::add(const std::vector<std::string>& keys, std::vector<std::string> cells) {
  Listed item;
  for (std::size_t i = 0; i < keys.size(); ++i) item.json.emplace_back(keys[i], json_text(cells[i]));
  item.rows.push_back(std::move(cells));
  items.push_back(std::move(item));
}

void Listing::keep(std::string_view word) {
  const std::string wanted = lower_case(word);
  const auto holds = [&](const std::string& text) { return lower_case(text).find(wanted) != std::string::npos; };
  std::erase_if(items, [&](const Listed& item) {
    for (const auto& row : item.rows)
      for (const std::string& cell : row)
        if (holds(cell)) return false;
    return true;
  });
}

std::string listing_text(const Listing& listing, std::size_t columns) {
  return listing.layout == Listing::table ? table_text(listing, columns) : paragraphs_text(listing, columns);
}

std::string listing_json(const Listing& listing) {
  std::string text = "[";
  for (const Listed& item : listing.items) {
    text += &item == listing.items.data() ? "\n" : ",\n";
    std::string object;
    for (const auto& [key, value] : item.json)
      object += fmt::format("{}{}: {}", object.empty() ? "" : ", ", json_text(key), value);
    text += "{" + object + "}";
  }
  return text + "\n]\n";
}

}  // namespace impinge
