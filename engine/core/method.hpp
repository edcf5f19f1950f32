// What every registered method has in common: settings of its own, declared where they are used.
#pragma once

#include <span>

#include "engine/core/rows.hpp"

namespace impinge {

/// A row of a method by name, with its value as text: {"form", "explicit"}.
using RowText = std::pair<std::string, std::string>;

class Method {
 public:
  virtual ~Method() = default;
  /// Declares the method's own rows; they are bound to this object. Most methods have none.
  virtual void declare(const Rows&) {}
};

/// Sets rows of a method that is in no MethodSet. Throws InputError as parse_value does, or for a row that isn't there.
void configure(Method& method, std::span<const RowText> rows);

/// Gives `to` the settings of `from`, a method of the same class.
void copy_settings(Method& from, Method& to);

}  // namespace impinge
