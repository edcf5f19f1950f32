// The bodies of a scene, in its order.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string_view>

#include "engine/bodies/body.hpp"

namespace impinge {

/// Owns them: a body stays where it is in memory for as long as the list lives.
class Bodies {
 public:
  /// Of two of one name the first keeps it.
  Body& add(std::unique_ptr<Body> body);

  BodyIndex size() const { return BodyIndex(bodies_.size()); }
  bool is_empty() const { return bodies_.empty(); }
  Body& operator[](BodyIndex i) { return *bodies_[static_cast<std::size_t>(i.value())]; }
  const Body& operator[](BodyIndex i) const { return *bodies_[static_cast<std::size_t>(i.value())]; }
  template <std::integral Number>
  Body& operator[](Number i) {
    return (*this)[BodyIndex(i)];
  }
  template <std::integral Number>
  const Body& operator[](Number i) const {
    return (*this)[BodyIndex(i)];
  }
  Body& back() { return *bodies_.back(); }
  const Body& back() const { return *bodies_.back(); }
  void remove_last();

  /// Two that never touch, whatever their surfaces do.
  void keep_from_touching(BodyIndex a, BodyIndex b);
  bool never_touch(BodyIndex a, BodyIndex b) const;

  /// None where there is none of that name.
  BodyIndex find(std::string_view name) const;
  std::vector<std::string> names() const;

  template <class Pointer, class Element>
  class Iterator {
   public:
    explicit Iterator(Pointer at) : at_(at) {}
    Element& operator*() const { return **at_; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const Iterator&) const = default;

   private:
    Pointer at_;
  };
  auto begin() { return Iterator<std::unique_ptr<Body>*, Body>(bodies_.data()); }
  auto end() { return Iterator<std::unique_ptr<Body>*, Body>(bodies_.data() + bodies_.size()); }
  auto begin() const { return Iterator<const std::unique_ptr<Body>*, const Body>(bodies_.data()); }
  auto end() const { return Iterator<const std::unique_ptr<Body>*, const Body>(bodies_.data() + bodies_.size()); }

 private:
  std::vector<std::unique_ptr<Body>> bodies_;
  std::map<std::string, BodyIndex, std::less<>> index_;
  std::vector<std::pair<BodyIndex, BodyIndex>> never_touch_;  // sorted; the lower one first
};

}  // namespace impinge
