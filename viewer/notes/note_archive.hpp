// What a note knows so far, to bytes and back: one list of members a note, in the same order both ways.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/core/archive.hpp"

namespace impinge {

class NoteArchive {
 public:
  explicit NoteArchive(ByteWriter& out) : out_(&out) {}
  explicit NoteArchive(ByteReader& in) : in_(&in) {}

  bool reads() const { return in_ != nullptr; }

  template <class... T>
  void keep(T&... values) {
    (one(values), ...);
  }
  /// `each(value)` keeps the members of one.
  template <class T, class Each>
  void list(std::vector<T>& values, Each each) {
    values.resize(count(values.size()));
    for (T& value : values) each(value);
  }
  template <class Key, class T, class Each>
  void map(std::map<Key, T>& values, Each each) {
    const std::size_t size = count(values.size());
    if (!reads()) {
      for (auto& [key, value] : values) {
        Key copy = key;
        one(copy);
        each(value);
      }
      return;
    }
    values.clear();
    for (std::size_t i = 0; i < size; ++i) {
      Key key{};
      one(key);
      each(values[key]);
    }
  }
  /// How many there are; of what is read no more than there are bytes left.
  std::size_t count(std::size_t size) {
    auto number = static_cast<std::uint64_t>(size);
    one(number);
    if (reads() && number > in_->left()) throw InputError("snapshot: its notes are damaged; remove it and run again");
    return static_cast<std::size_t>(number);
  }

 private:
  template <class T>
  requires std::is_arithmetic_v<T>
  void one(T& value) {
    if (reads())
      value = in_->get<T>();
    else
      out_->put(value);
  }
  template <class T>
  requires std::is_enum_v<T>
  void one(T& value) {
    auto number = static_cast<std::underlying_type_t<T>>(value);
    one(number);
    value = static_cast<T>(number);
  }
  void one(std::string& text) {
    text.resize(count(text.size()));
    for (char& c : text) one(c);
  }

  ByteWriter* out_ = nullptr;
  ByteReader* in_ = nullptr;
};

}  // namespace impinge
