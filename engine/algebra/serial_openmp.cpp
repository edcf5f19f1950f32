#include "engine/algebra/serial_openmp.hpp"

#include <dlfcn.h>

namespace impinge {
namespace {

/// The runtime that CHOLMOD was linked with, found by name: linking one of our own could add a second.
struct Runtime {
  int (*get)() = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "omp_get_max_active_levels"));
  void (*set)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"));
  bool is_loaded() const { return get != nullptr && set != nullptr; }
};

const Runtime& runtime() {
  static const Runtime loaded;
  return loaded;
}

}  // namespace

SerialOpenMp::SerialOpenMp() {
  if (!runtime().is_loaded()) return;
  levels_ = runtime().get();
  runtime().set(0);
}

SerialOpenMp::~SerialOpenMp() {
  if (runtime().is_loaded()) runtime().set(levels_);
}

}  // namespace impinge
