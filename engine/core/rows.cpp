#include "engine/core/rows.hpp"

#include <algorithm>
#include <limits>

namespace impinge {

namespace {

template <class T>
Parameter row_for(std::string_view name, T& variable, ParameterKind kind, std::string doc) {
  Parameter row;
  row.path = name;
  row.kind = kind;
  row.doc = std::move(doc);
  row.initial = variable;
  row.get = [&variable] { return ParameterValue(variable); };
  row.set = [&variable](const ParameterValue& value) { variable = std::get<T>(value); };
  return row;
}

}  // namespace

Rows::Declared Rows::add(std::string_view name, bool& variable, std::string doc) const {
  return add(row_for(name, variable, ParameterKind::boolean, std::move(doc)));
}

Rows::Declared Rows::add(std::string_view name, int& variable, Range range, std::string unit, std::string doc) const {
  Parameter row;
  row.path = name;
  row.kind = ParameterKind::integer;
  row.range = {std::max(range.low, double(std::numeric_limits<int>::min())),
               std::min(range.high, double(std::numeric_limits<int>::max())), range.logarithmic};
  row.unit = std::move(unit);
  row.doc = std::move(doc);
  row.initial = std::int64_t{variable};
  row.get = [&variable] { return ParameterValue(std::int64_t{variable}); };
  row.set = [&variable](const ParameterValue& value) { variable = static_cast<int>(std::get<std::int64_t>(value)); };
  return add(std::move(row));
}

Rows::Declared Rows::add(std::string_view name, double& variable, Range range, std::string unit,
                         std::string doc) const {
  Parameter row = row_for(name, variable, ParameterKind::real, std::move(doc));
  row.range = range;
  row.unit = std::move(unit);
  return add(std::move(row));
}

Rows::Declared Rows::add(std::string_view name, Threshold& variable, Range range, std::string unit,
                         std::string doc) const {
  Parameter row;
  row.path = name;
  row.range = range;
  row.unit = std::move(unit);
  row.doc = std::move(doc);
  row.word = "auto";
  row.get = [&variable, word = row.word] {
    return variable.given ? ParameterValue(*variable.given) : ParameterValue(word);
  };
  row.set = [&variable](const ParameterValue& value) {
    const double* number = std::get_if<double>(&value);
    variable.given = number == nullptr ? std::optional<double>() : *number;
  };
  row.initial = row.get();
  return add(std::move(row));
}

Rows::Declared Rows::add(std::string_view name, Vec3& variable, Range range, std::string unit, std::string doc) const {
  Parameter row = row_for(name, variable, ParameterKind::vector3, std::move(doc));
  row.range = range;
  row.unit = std::move(unit);
  return add(std::move(row));
}

Rows::Declared Rows::add(std::string_view name, std::string& variable, std::string doc) const {
  return add(row_for(name, variable, ParameterKind::text, std::move(doc)));
}

Rows::Declared Rows::add(std::string_view name, std::vector<std::string>& variable, std::string doc) const {
  return add(row_for(name, variable, ParameterKind::text_list, std::move(doc)));
}

Rows::Declared Rows::add(Parameter row) const {
  row.path = path_of(row.path);
  const std::string& path = set_->add(std::move(row)).path;
  return Declared(*set_, path);
}

}  // namespace impinge
