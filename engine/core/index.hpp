// Indices that know what they count: an index into one kind of list is not taken for another's, by the compiler.
#pragma once

#include <compare>
#include <concepts>

namespace impinge {

/// Position in a list of `Of`s, from 0; -1 (the default): none. Made from a number only where that is written out;
/// reads as a number anywhere, so it subscripts any vector.
template <class Of>
class Index {
 public:
  constexpr Index() = default;
  template <std::integral Number>
  constexpr explicit Index(Number value) : value_(static_cast<int>(value)) {}

  constexpr int value() const { return value_; }
  constexpr operator int() const { return value_; }
  constexpr bool is_none() const { return value_ < 0; }

  constexpr Index& operator++() {
    ++value_;
    return *this;
  }
  friend constexpr bool operator==(Index l, Index r) { return l.value_ == r.value_; }
  friend constexpr auto operator<=>(Index l, Index r) { return l.value_ <=> r.value_; }
  // with the size of a list: none is no place of it
  template <std::unsigned_integral Count>
  friend constexpr bool operator==(Index l, Count r) {
    return static_cast<Count>(l.value_) == r;
  }
  template <std::unsigned_integral Count>
  friend constexpr std::strong_ordering operator<=>(Index l, Count r) {
    return static_cast<Count>(l.value_) <=> r;
  }
  template <class Other>
  friend bool operator==(Index, Index<Other>) = delete;
  template <class Other>
  friend auto operator<=>(Index, Index<Other>) = delete;

 private:
  int value_ = -1;
};

using BodyIndex = Index<class Body>;              ///< of the scene's bodies, in its order
using TriangleIndex = Index<struct TriangleTag>;  ///< of a surface
using ContactIndex = Index<struct ContactTag>;    ///< of a sub-step: its collisions, and after them its attachments
using GroupIndex = Index<struct GroupTag>;        ///< of a sub-step's collision groups

}  // namespace impinge
