#include "viewer/controller/interrupt.hpp"

#include <csignal>

namespace impinge {
namespace {

std::atomic<bool> g_interrupted{false};

void on_interrupt(int signal) {
  g_interrupted.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interrupt() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

const std::atomic<bool>& interrupted() { return g_interrupted; }

}  // namespace impinge
