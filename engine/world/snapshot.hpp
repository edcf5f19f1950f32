// The full state as bytes (World::save says what it is for), kept in parts so that a frame writes only what it changed, and
// the hash of all of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/bodies/bodies.hpp"
#include "engine/contact/contact_cache.hpp"
#include "engine/step/sleeping.hpp"

namespace impinge {

class StateBytes {
 public:
  /// Takes the state as it is now: of bodies that it knows already only the active ones.
  void take(int frame, double time, const Bodies& bodies, const ContactCache& cache, const Sleeping& sleeping);
  /// Another frame in which everything else is the same.
  void set_time(int frame, double time) { frame_ = frame, time_ = time; }
  /// What the body's save() wrote when it was taken.
  std::string_view of(BodyIndex body) const;
  /// Of all in the order of write().
  std::uint64_t hash() const;
  void write(ByteWriter& out) const;

 private:
  int frame_ = 0;
  double time_ = 0.0;
  std::string bodies_;
  std::vector<std::size_t> begin_;  // by body, in bodies_, and its end
  ContactCache cache_;
  Sleeping sleeping_;
};

}  // namespace impinge
