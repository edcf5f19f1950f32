// Something that is made when it is asked for first, by whichever thread asks first.
#pragma once

#include <memory>
#include <mutex>

namespace impinge {

/// What copies of an object don't share: a copy starts with a state of its own, as if new.
template <class State>
class OwnState {
 public:
  OwnState() = default;
  OwnState(const OwnState&) : OwnState() {}
  OwnState& operator=(const OwnState&) {
    state_ = std::make_shared<State>();
    return *this;
  }
  State& operator*() const { return *state_; }

 private:
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

/// A copy starts anew: what was made belongs to the original. T may be incomplete but where it is made.
template <class T>
class Lazily {
 public:
  template <class Make>
  const T& get(Make&& make) const {
    State& state = *state_;
    std::call_once(state.once, [&] { state.value = std::make_shared<const T>(make()); });
    return *state.value;
  }

 private:
  struct State {
    std::once_flag once;
    std::shared_ptr<const T> value;
  };
  OwnState<State> state_;
};

/// The same for something that is made in one of several ways: anew where `is_wanted` denies what was made last. One that
/// is in use stays with its users.
template <class T>
class LazilyAnew {
 public:
  template <class IsWanted, class Make>
  std::shared_ptr<const T> get(IsWanted&& is_wanted, Make&& make) const {
    State& state = *state_;
    const std::lock_guard lock(state.mutex);
    if (!state.value || !is_wanted(*state.value)) state.value = make();
    return state.value;
  }

 private:
  struct State {
    std::mutex mutex;
    std::shared_ptr<const T> value;
  };
  OwnState<State> state_;
};

}  // namespace impinge
