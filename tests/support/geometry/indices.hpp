// Indices written as numbers, as tests may.
#pragma once

#include <initializer_list>
#include <vector>

#include "engine/detection/collision.hpp"

namespace impinge::test {

inline BodyPair body_pair(int a, int b, double margin) { return {BodyIndex(a), BodyIndex(b), margin}; }

inline TrianglePair triangle_pair(int a, int b, int triangle_a, int triangle_b, bool intersecting) {
  return {BodyIndex(a), BodyIndex(b), TriangleIndex(triangle_a), TriangleIndex(triangle_b), intersecting};
}

template <class Index>
std::vector<Index> indices(std::initializer_list<int> numbers) {
  std::vector<Index> list;
  for (const int number : numbers) list.emplace_back(number);
  return list;
}

}  // namespace impinge::test
