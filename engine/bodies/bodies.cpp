#include "engine/bodies/bodies.hpp"

namespace impinge {

Body& Bodies::add(std::unique_ptr<Body> body) {
  index_.emplace(body->name, size());
  bodies_.push_back(std::move(body));
  return *bodies_.back();
}

BodyIndex Bodies::find(std::string_view name) const {
  const auto it = index_.find(name);
  return it == index_.end() ? BodyIndex() : it->second;
}

std::vector<std::string> Bodies::names() const {
  std::vector<std::string> names;
  for (const Body& body : *this) names.push_back(body.name);
  return names;
}

}  // namespace impinge
