// The settings of one layer, whatever they are: a struct of the layer's file with `void declare(const Rows&)`, copied
// with the view that has them.
#pragma once

#include <any>

#include "engine/core/error.hpp"
#include "engine/core/rows.hpp"

namespace impinge {

class LayerSettings {
 public:
  LayerSettings() = default;  ///< of a layer without any
  template <class Settings>
  requires requires(Settings& settings, const Rows& rows) { settings.declare(rows); }
  LayerSettings(Settings settings)  // NOLINT: a layer hands over its struct as it is
      : value_(std::move(settings)),
        declare_([](std::any& value, const Rows& rows) { std::any_cast<Settings&>(value).declare(rows); }) {}

  /// Declares the layer's rows; they are bound to this object.
  void declare(const Rows& rows) {
    if (declare_ != nullptr) declare_(value_, rows);
  }
  template <class Settings>
  const Settings& as() const {
    const Settings* settings = std::any_cast<Settings>(&value_);
    if (settings == nullptr) throw InternalError("a layer has settings of another type");
    return *settings;
  }

 private:
  std::any value_;
  void (*declare_)(std::any&, const Rows&) = nullptr;
};

}  // namespace impinge
