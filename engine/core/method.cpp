#include "engine/core/method.hpp"

#include "engine/core/error.hpp"

namespace impinge {

void configure(Method& method, std::span<const RowText> rows) {
  ParameterSet set;
  method.declare(Rows(set));
  for (const auto& [name, text] : rows) {
    const Parameter* row = set.find(name);
    if (row == nullptr) throw InputError(set.unknown_message(name));
    row->set(parse_value(*row, text));
  }
}

void copy_settings(Method& from, Method& to) {
  ParameterSet of_from, of_to;
  from.declare(Rows(of_from));
  to.declare(Rows(of_to));
  for (const Parameter& row : of_to.all()) row.set(of_from.find(row.path)->get());
}

}  // namespace impinge
