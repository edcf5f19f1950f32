// A registry is an ordered, explicit list: one line in a folder's all.cpp adds an algorithm everywhere. (Objects that
// register themselves are dropped by the linker when they live in a static library and nobody names their file.)
//
//   const Registry<LcpSolver>& lcp_solvers() {
//     static const Registry<LcpSolver> list = [] {
//       Registry<LcpSolver> all;
//       IMPINGE_LIST(all, my_solver);      // the line: my_solver.cpp defines Entry<LcpSolver> my_solver()
//       return all;
//     }();
//     return list;
//   }
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace impinge {

/// One registered algorithm: the name users write, one line of what it is, and how to make one.
template <class Interface>
struct Entry {
  std::string_view name;
  std::string_view doc;
  std::unique_ptr<Interface> (*make)();
};

template <class Interface>
using Registry = std::vector<Entry<Interface>>;

template <class Interface, class Concrete>
Entry<Interface> entry(std::string_view name, std::string_view doc) {
  return {name, doc, [] { return std::unique_ptr<Interface>(std::make_unique<Concrete>()); }};
}

/// The entry of that name, or nullptr.
template <class Interface>
const Entry<Interface>* find_entry(const Registry<Interface>& registry, std::string_view name) {
  for (const Entry<Interface>& e : registry)
    if (e.name == name) return &e;
  return nullptr;
}

/// A new object of that name. Rows offer registered names only, so another one is a bug.
template <class Interface>
std::unique_ptr<Interface> make_named(const Registry<Interface>& registry, std::string_view name) {
  const Entry<Interface>* found = find_entry(registry, name);
  if (found == nullptr) throw InternalError("no registered algorithm is named '" + std::string(name) + "'");
  return found->make();
}

/// Declares the function `maker` of the namespace around it, which another file defines, and appends what it makes.
#define IMPINGE_LIST(list, maker)              \
  do {                                         \
    extern decltype(list)::value_type maker(); \
    (list).push_back(maker());                 \
  } while (false)

}  // namespace impinge
