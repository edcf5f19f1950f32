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

}  // namespace impinge
