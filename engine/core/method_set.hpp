// The methods of a kind as parameters have them: one object of each, with its settings, and which one is in use.
#pragma once

#include "engine/core/method.hpp"
#include "engine/core/registry.hpp"

namespace impinge {

template <class Interface>
class MethodSet {
 public:
  /// The list's first method is in use.
  explicit MethodSet(const Registry<Interface>& registry) {
    for (const Entry<Interface>& entry : registry) methods_.push_back({&entry, entry.make()});
  }

  /// Puts the method of that name in use. Rows offer registered names only, so another one is a bug: InternalError.
  MethodSet& operator=(std::string_view name) {
    used_ = index_of(name);
    return *this;
  }
  std::string_view name() const { return methods_[used_].entry->name; }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Owned& method : methods_) names.emplace_back(method.entry->name);
    return names;
  }

  Interface& operator*() const { return *methods_[used_].method; }
  Interface* operator->() const { return methods_[used_].method.get(); }
  /// Whether in use or not.
  Interface& at(std::string_view name) const { return *methods_[index_of(name)].method; }

  /// Declares the rows of every method, each below its name.
  void declare(const Rows& rows) const {
    for (const Owned& method : methods_) method.method->declare(rows.below(method.entry->name));
  }

 private:
  struct Owned {
    const Entry<Interface>* entry;
    std::unique_ptr<Interface> method;
  };
  std::size_t index_of(std::string_view name) const {
    for (std::size_t i = 0; i < methods_.size(); ++i)
      if (methods_[i].entry->name == name) return i;
    throw InternalError("no registered method is named '" + std::string(name) + "'");
  }

  std::vector<Owned> methods_;
  std::size_t used_ = 0;
};

}  // namespace impinge
