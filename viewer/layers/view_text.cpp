#include "viewer/layers/view_text.hpp"

#include "viewer/layers/layer.hpp"

namespace impinge {

std::string view_text(ViewSettings settings) {
  ViewSettings plain = make_view_settings();
  ParameterSet own, usual;
  settings.bind(own);
  plain.bind(usual);
  std::string text;
  for (const Parameter& row : own.all()) {
    if (row.path.starts_with("view.layer.")) continue;  // view.layers says it
    const std::string value = format_value(row.get());
    const Parameter* other = usual.find(row.path);
    if (row.path.starts_with("view.camera.") || other == nullptr || format_value(other->get()) != value)
      text += (text.empty() ? "" : "\n") + row.path + " = " + value;
  }
  return text;
}

}  // namespace impinge
