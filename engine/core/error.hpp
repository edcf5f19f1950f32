// What can go wrong, as types. The library throws, main catches once and turns the type into an exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace impinge {

/// The user's input can't be taken (exit code 2). One message: `file:line:column: what was found; what is allowed;
/// remedy`.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The simulation left the finite numbers (exit code 3). Names frame, group and body.
struct DivergenceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A bug of ours (exit code 4): a condition that the code relies on does not hold.
struct InternalError : std::logic_error {
  using std::logic_error::logic_error;
};

/// Throws InternalError with the condition's text unless it holds.
#define IMPINGE_ASSERT(condition)                                                                             \
  do {                                                                                                        \
    if (!(condition)) throw ::impinge::InternalError(std::string(__FILE__) + ": does not hold: " #condition); \
  } while (false)

}  // namespace impinge
