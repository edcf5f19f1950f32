// Bodies by name: looked up once for every mention, so not by walking along all of them.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace impinge {

class BodyNames {
 public:
  /// The next body's name; of two alike the first one keeps it.
  void add(const std::string& name) {
    index_.emplace(name, static_cast<int>(names_.size()));
    names_.push_back(name);
  }
  /// Index of the body in the scene's order, −1 where there is none of that name.
  int find(std::string_view name) const {
    const auto it = index_.find(name);
    return it == index_.end() ? -1 : it->second;
  }
  const std::vector<std::string>& all() const { return names_; }  ///< in the scene's order

 private:
  std::vector<std::string> names_;
  std::map<std::string, int, std::less<>> index_;
};

}  // namespace impinge
