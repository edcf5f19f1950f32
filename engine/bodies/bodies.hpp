// The bodies of a scene, in its order.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
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
  /// How many are there, which are the first ones: those that are absent come behind them.
  BodyIndex present() const;

  // who is looked at: a sub-step costs nothing for the others
  /// Ascending: who moves, or may, and who did or was changed a short while ago. Whatever is known by body of anyone else
  /// stays true. Whoever changes a body from outside of a sub-step makes it, or all, active.
  std::span<const BodyIndex> active() const { return active_; }
  bool all_active() const { return active_.size() == bodies_.size(); }
  /// Of whom something that is kept by body has to be made again: the active ones, or all where nothing is known yet.
  std::span<const BodyIndex> to_renew(bool is_known) const { return is_known ? active_ : all_; }
  /// `more`: ascending.
  void activate(std::span<const BodyIndex> more);
  void activate_all();
  /// At a frame's start: lets go of who was still, by is_still(body), at the end of the last two. So what is kept twice, of
  /// one frame and the next, knows of it both times.
  template <class IsStill>
  void let_rest(IsStill&& is_still) {
    std::erase_if(active_, [&](BodyIndex b) {
      char& frames = frames_left_[static_cast<std::size_t>(b.value())];
      if (!is_still((*this)[b])) frames = kFramesActive;
      return frames-- == 0;
    });
  }

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
  static constexpr char kFramesActive = 2;

  std::vector<std::unique_ptr<Body>> bodies_;
  std::vector<BodyIndex> all_, active_;
  std::vector<char> frames_left_;  // by body: for which it is active still
  std::map<std::string, BodyIndex, std::less<>> index_;
  std::vector<std::pair<BodyIndex, BodyIndex>> never_touch_;  // sorted; the lower one first
};

}  // namespace impinge
