// How variables become parameter rows. Who declares them sees a part of the set below a common path, so a method's file
// says `rows.add("slip_speed", ...)` and need not know that this is `response.penalty.slip_speed`.
#pragma once

#include <type_traits>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/core/threshold.hpp"

namespace impinge {

/// What a choice may be, each with the word that users write.
template <class Enum>
using Words = std::vector<std::pair<Enum, std::string>>;

template <class Enum>
const std::string& word_of(const Words<Enum>& words, Enum value) {
  for (const auto& [known, word] : words)
    if (known == value) return word;
  throw InternalError("a choice without a word");
}

class Rows {
 public:
  /// Rows of `set`, which must outlive this, below `path`; "" for whole paths.
  explicit Rows(ParameterSet& set, std::string path = "") : set_(&set), path_(std::move(path)) {}

  Rows below(std::string_view name) const { return Rows(*set_, path_of(name)); }
  std::string path_of(std::string_view name) const {
    return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
  }

  /// A row just declared, to say more of it.
  class Declared {
   public:
    Declared(ParameterSet& set, std::string path) : set_(&set), path_(std::move(path)) {}
    /// Its whole path in earlier versions.
    const Declared& formerly(std::string path) const {
      set_->add_former_path(std::move(path), path_);
      return *this;
    }
    const std::string& path() const { return path_; }

   private:
    ParameterSet* set_;
    std::string path_;
  };

  // Bound to a variable that must stay where it is; its present value is the default.
  Declared add(std::string_view name, bool& variable, std::string doc) const;
  Declared add(std::string_view name, int& variable, Range range, std::string unit, std::string doc) const;
  Declared add(std::string_view name, double& variable, Range range, std::string unit, std::string doc) const;
  /// A number, or the word "auto".
  Declared add(std::string_view name, Threshold& variable, Range range, std::string unit, std::string doc) const;
  Declared add(std::string_view name, Vec3& variable, Range range, std::string unit, std::string doc) const;
  Declared add(std::string_view name, std::string& variable, std::string doc) const;
  Declared add(std::string_view name, std::vector<std::string>& variable, std::string doc) const;
  template <class Enum>
  requires std::is_enum_v<Enum> Declared add(std::string_view name, Enum& variable,
                                             std::type_identity_t<Words<Enum>> words, std::string doc)
  const;
  /// One of several registered things: what knows their `names()`, its own `name()`, and takes one by assignment.
  template <class Choice>
  requires requires(Choice& choice) { choice = choice.names().front(), choice.name(); }
  Declared add(std::string_view name, Choice& choice, std::string doc) const;
  /// With its own get and set; its path is a name here.
  Declared add(Parameter row) const;

 private:
  ParameterSet* set_;
  std::string path_;
};

template <class Enum>
requires std::is_enum_v<Enum> Rows::Declared Rows::add(std::string_view name, Enum& variable,
                                                       std::type_identity_t<Words<Enum>> words, std::string doc)
const {
  Parameter row;
  row.path = name;
  row.kind = ParameterKind::choice;
  row.doc = std::move(doc);
  for (const auto& [value, word] : words) row.names.push_back(word);
  row.get = [&variable, words] { return ParameterValue(word_of(words, variable)); };
  row.set = [&variable, words](const ParameterValue& wanted) {
    for (const auto& [value, word] : words)
      if (word == std::get<std::string>(wanted)) variable = value;
  };
  row.initial = row.get();
  return add(std::move(row));
}

template <class Choice>
requires requires(Choice& choice) { choice = choice.names().front(), choice.name(); }
Rows::Declared Rows::add(std::string_view name, Choice& choice, std::string doc) const {
  Parameter row;
  row.path = name;
  row.kind = ParameterKind::choice;
  row.doc = std::move(doc);
  row.names = choice.names();
  row.get = [&choice] { return ParameterValue(std::string(choice.name())); };
  row.set = [&choice](const ParameterValue& wanted) { choice = std::get<std::string>(wanted); };
  row.initial = row.get();
  return add(std::move(row));
}

}  // namespace impinge
