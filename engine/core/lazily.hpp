// Something that is made when it is asked for first, by whichever thread asks first.
#pragma once

#include <memory>
#include <mutex>

namespace impinge {

/// A copy starts anew: what was made belongs to the original. T may be incomplete but where it is made.
template <class T>
class Lazily {
 public:
  Lazily() = default;
  Lazily(const Lazily&) : Lazily() {}
  Lazily& operator=(const Lazily&) {
    state_ = std::make_shared<State>();
    return *this;
  }

  template <class Make>
  const T& get(Make&& make) const {
    std::call_once(state_->once, [&] { state_->value = std::make_shared<const T>(make()); });
    return *state_->value;
  }

 private:
  struct State {
    std::once_flag once;
    std::shared_ptr<const T> value;
  };
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

/// The same for something that is made in one of several ways: anew where `is_wanted` denies what was made last. One that
/// is in use stays with its users.
template <class T>
class LazilyAnew {
 public:
  LazilyAnew() = default;
  LazilyAnew(const LazilyAnew&) : LazilyAnew() {}
  LazilyAnew& operator=(const LazilyAnew&) {
    state_ = std::make_shared<State>();
    return *this;
  }

  template <class IsWanted, class Make>
  std::shared_ptr<const T> get(IsWanted&& is_wanted, Make&& make) const {
    const std::lock_guard lock(state_->mutex);
    if (!state_->value || !is_wanted(*state_->value)) state_->value = make();
    return state_->value;
  }

 private:
  struct State {
    std::mutex mutex;
    std::shared_ptr<const T> value;
  };
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace impinge
