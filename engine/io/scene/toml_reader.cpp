// The reader of TOML 1.0: keys, tables, arrays. Linear in the length of the text, recursive to a bounded depth.
//
// Own code, since neither library at hand will do (Debian 12, measured on 10,000 bodies, 1.6 MB): toml11 3.7 takes
// more than a second and reads beyond its buffer; toml++ 3.3 takes a fifth of that, but the square of the number of
// dotted keys, and half a minute of random changes leads it to places that it calls unreachable.
#include <deque>
#include <map>

#include "engine/io/scene/toml_prescan.hpp"
#include "engine/io/scene/toml_scalar.hpp"

namespace impinge {

namespace {

using Spot = TomlCursor::Spot;

/// A table while it grows, or the tables of [[...]]. Stays where it is.
struct Draft {
  enum Form {
    implied,  ///< by a longer head: [a.b] implies a
    headed,   ///< by a head of its own
    dotted,   ///< by dotted keys
    list,     ///< of tables, by [[...]]
  };
  struct Entry {
    std::string key, place;
    TomlNode value;          ///< where there is no table
    Draft* table = nullptr;  ///< the entry is one, or a list of them
  };

  Form form = implied;
  int section = 0;  ///< of dotted ones: the head below which they came into being; they can be added to only there
  std::string place;
  std::vector<Entry> entries;
  std::map<std::string, std::size_t, std::less<>> index;  ///< of the entries, where they are many
  std::vector<Draft*> elements;                           ///< of a list

  Entry* find(std::string_view key) {
    if (!index.empty()) {
      const auto it = index.find(key);
      return it == index.end() ? nullptr : &entries[it->second];
    }
    for (Entry& entry : entries)
      if (entry.key == key) return &entry;
    return nullptr;
  }
  Entry& add(const std::string& key, std::string at) {
    constexpr std::size_t kFew = 16;
    entries.push_back({key, std::move(at), {}, nullptr});
    if (entries.size() == kFew)
      for (std::size_t i = 0; i < entries.size(); ++i) index.emplace(entries[i].key, i);
    else if (entries.size() > kFew)
      index.emplace(key, entries.size() - 1);
    return entries.back();
  }
};

TomlNode finished(Draft& draft) {
  TomlNode node;
  node.place = std::move(draft.place);
  if (draft.form == Draft::list) {
    node.kind = TomlNode::array;
    node.items.reserve(draft.elements.size());
    for (Draft* element : draft.elements) node.items.push_back(finished(*element));
    return node;
  }
  node.kind = TomlNode::table;
  node.entries.reserve(draft.entries.size());
  for (Draft::Entry& entry : draft.entries)
    node.entries.push_back({std::move(entry.key), std::move(entry.place),
                            entry.table != nullptr ? finished(*entry.table) : std::move(entry.value)});
  return node;
}

class Reader {
 public:
  Reader(const std::string& name, std::string_view text) : in_(name, text) {}

  TomlNode read() {
    Draft& root = make(Draft::headed, in_.spot());
    Draft* table = &root;
    for (;;) {
      in_.skip_blanks();
      if (in_.at_end()) return finished(root);
      if (in_.peek() == '[')
        table = &read_head(root);
      else if (in_.peek() != '#' && !in_.at_line_end())
        read_entry(*table, section_levels_);
      end_line();
    }
  }

 private:
  struct Part {
    std::string key;
    Spot spot;
  };

  Draft& make(Draft::Form form, Spot spot) {
    Draft& draft = drafts_.emplace_back();
    draft.form = form;
    draft.section = section_;
    draft.place = in_.place(spot);
    return draft;
  }

  void end_line() {
    in_.skip_blanks();
    in_.skip_remark();
    if (in_.at_end()) return;
    if (!in_.at_line_end()) in_.fail(in_.found() + " where the line should end");
    in_.skip_line_end();
  }

  void check_depth(int levels) const {
    if (levels <= kMostTomlDepth) return;
    throw InputError(
        fmt::format("{}: values nested deeper than {} levels (open brackets, and the parts of dotted keys and of table "
                    "heads, count); flatter values are wanted; unfold them",
                    in_.place(), kMostTomlDepth));
  }

  /// A key of one or more parts; `levels` it lies deep.
  std::vector<Part> read_key(int levels) {
    const auto is_bare = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    std::vector<Part> parts;
    for (;;) {
      in_.skip_blanks();
      Part& part = parts.emplace_back();
      part.spot = in_.spot();
      if (in_.peek() == '"' || in_.peek() == '\'') {
        part.key = read_toml_text(in_, false);
      } else {
        std::size_t length = 0;
        while (is_bare(in_.peek(length))) ++length;
        if (length == 0)
          in_.fail(in_.found() + " where a key should stand (letters, digits, _ and -; others in quotes)");
        part.key = in_.rest().substr(0, length);
        in_.skip(length);
      }
      in_.skip_blanks();
      if (in_.peek() != '.') return parts;
      check_depth(levels + static_cast<int>(parts.size()) + 1);
      in_.skip();
    }
  }

  [[noreturn]] void refuse_second(Spot spot, const std::string& key, const Draft::Entry& first) const {
    const std::size_t column = first.place.rfind(':'), line = first.place.rfind(':', column - 1);
    in_.fail_at(spot, fmt::format("'{}' already exists, in line {}", shortened(key, 60),
                                  first.place.substr(line + 1, column - line - 1)));
  }

  /// [a.b] or [[a.b]]: the table that the lines after it are of.
  Draft& read_head(Draft& root) {
    const Spot begin = in_.spot();
    const bool is_list = in_.starts_with("[[");
    in_.skip(is_list ? 2 : 1);
    const std::vector<Part> parts = read_key(is_list ? 1 : 0);
    if (!in_.starts_with(is_list ? "]]" : "]"))
      in_.fail_at(begin, fmt::format("a table's head that is not closed by '{}'", is_list ? "]]" : "]"));
    in_.skip(is_list ? 2 : 1);
    ++section_;
    section_levels_ = static_cast<int>(parts.size()) + is_list;

    Draft* table = &root;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
      Draft::Entry* entry = table->find(parts[i].key);
      if (entry == nullptr) {
        entry = &table->add(parts[i].key, in_.place(parts[i].spot));
        entry->table = &make(Draft::implied, begin);
      }
      if (entry->table == nullptr) refuse_second(begin, parts[i].key, *entry);
      table = entry->table->form == Draft::list ? entry->table->elements.back() : entry->table;
    }
    const Part& last = parts.back();
    Draft::Entry* entry = table->find(last.key);
    if (entry == nullptr) {
      entry = &table->add(last.key, in_.place(last.spot));
      entry->table = &make(is_list ? Draft::list : Draft::headed, begin);
      if (!is_list) return *entry->table;
    } else if (entry->table == nullptr || entry->table->form != (is_list ? Draft::list : Draft::implied)) {
      refuse_second(begin, last.key, *entry);
    } else if (!is_list) {
      entry->table->form = Draft::headed;
      entry->table->place = in_.place(begin);
      return *entry->table;
    }
    return *entry->table->elements.emplace_back(&make(Draft::headed, begin));
  }

  /// key = value, in a table that lies `levels` deep.
  void read_entry(Draft& in_table, int levels) {
    const std::vector<Part> parts = read_key(levels);
    if (in_.peek() != '=') in_.fail(in_.found() + " where '=' should follow the key");
    in_.skip();
    in_.skip_blanks();
    const Spot spot = in_.spot();
    Draft* table = &in_table;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
      Draft::Entry* entry = table->find(parts[i].key);
      if (entry == nullptr) {
        entry = &table->add(parts[i].key, in_.place(parts[i].spot));
        entry->table = &make(Draft::dotted, parts[i].spot);
      }
      Draft* next = entry->table;
      if (next != nullptr && next->form == Draft::implied) next->form = Draft::dotted, next->section = section_;
      if (next == nullptr || next->form != Draft::dotted || next->section != section_)
        refuse_second(spot, parts[i].key, *entry);
      table = next;
    }
    if (const Draft::Entry* first = table->find(parts.back().key)) refuse_second(spot, parts.back().key, *first);
    const std::size_t index = table->entries.size();
    table->add(parts.back().key, in_.place(parts.back().spot));
    table->entries[index].value = read_value(levels + (parts.size() > 1 ? static_cast<int>(parts.size()) : 0));
  }

  TomlNode read_value(int levels) {
    const Spot begin = in_.spot();
    TomlNode node;
    if (in_.peek() == '"' || in_.peek() == '\'')
      node.kind = TomlNode::text, node.string = read_toml_text(in_, true);
    else if (in_.peek() == '[')
      node = read_array(begin, levels + 1);
    else if (in_.peek() == '{')
      node = read_inline_table(begin, levels + 1);
    else
      node = read_toml_word(in_);
    node.place = in_.place(begin);
    return node;
  }

  // blanks, remarks and line ends
  void skip_space(Spot begin) {
    for (;;) {
      in_.skip_blanks();
      in_.skip_remark();
      if (in_.at_end()) in_.fail_at(begin, "an array that is not closed by ']'");
      if (!in_.at_line_end()) return;
      in_.skip_line_end();
    }
  }

  TomlNode read_array(Spot begin, int levels) {
    check_depth(levels);
    in_.skip();
    TomlNode node;
    node.kind = TomlNode::array;
    for (;;) {
      skip_space(begin);
      if (in_.peek() == ']') break;
      node.items.push_back(read_value(levels));
      skip_space(begin);
      if (in_.peek() == ']') break;
      if (in_.peek() != ',') in_.fail(in_.found() + " where ',' or ']' should follow in an array");
      in_.skip();
    }
    in_.skip();
    return node;
  }

  TomlNode read_inline_table(Spot begin, int levels) {
    check_depth(levels);
    in_.skip();
    // its dotted tables are its own: no later line adds to them, and it adds to none of those before
    const int outside = section_;
    section_ = ++inline_tables_;
    Draft& table = make(Draft::headed, begin);
    in_.skip_blanks();
    while (in_.peek() != '}' || !table.entries.empty()) {
      read_entry(table, levels);
      in_.skip_blanks();
      if (in_.peek() == '}') break;
      if (in_.peek() != ',')
        in_.fail(in_.found() + " where ',' or '}' should follow in an inline table, which is of one line");
      in_.skip();
    }
    in_.skip();
    section_ = outside;
    return finished(table);
  }

  TomlCursor in_;
  std::deque<Draft> drafts_;
  int section_ = 0, section_levels_ = 0;  // of the last head
  int inline_tables_ = 1 << 30;           // sections of theirs, beyond those of all heads
};

}  // namespace

TomlNode parse_toml(const std::string& name, const std::string& text) {
  return Reader(name, prescanned_toml(name, text)).read();
}

}  // namespace impinge
