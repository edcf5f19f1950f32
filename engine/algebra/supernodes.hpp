// Where a sparse Cholesky factor has its numbers: supernodes, blocks of columns with the same rows below. A node's rows
// below are all among those of its parent, so that what it leaves for others goes to its parent alone (multifrontal
// [Duff83]); and what hangs below different nodes can be worked at side by side.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace impinge {

class Supernodes {
 public:
  /// Nodes come before their parents. first: of each node's columns, and the number of all; begin, rows: of each node its
  /// rows in ascending order, its own columns first; order: which unknown stands at each place.
  Supernodes(std::vector<int> first, std::vector<int> begin, std::vector<int> rows, std::vector<int> order);

  int count() const { return static_cast<int>(parent_.size()); }
  int unknowns() const { return static_cast<int>(order_.size()); }
  const std::vector<int>& order() const { return order_; }
  const std::vector<int>& place() const { return place_; }  ///< of each unknown

  int first(int node) const { return first_[at(node)]; }
  int width(int node) const { return first_[at(node) + 1] - first_[at(node)]; }
  int height(int node) const { return begin_[at(node) + 1] - begin_[at(node)]; }
  int below(int node) const { return height(node) - width(node); }
  std::span<const int> rows(int node) const { return part(rows_, node); }
  /// Which of its parent's rows each row is; of those below only.
  std::span<const int> rows_of_parent(int node) const { return part(row_of_parent_, node).subspan(at(width(node))); }
  const std::vector<int>& children(int node) const { return children_[at(node)]; }
  int node_of(int place) const { return node_of_[at(place)]; }

  /// Where a node's height × width numbers begin, by columns; of count(): how many there are.
  std::size_t values(int node) const { return values_[at(node)]; }
  /// The most numbers that are handed on and wait, in one thread.
  std::size_t waiting() const { return waiting_; }

  /// Nodes come in tasks; what a task needs of others is what its children have left. Tasks don't depend on how many
  /// threads there are.
  int tasks() const { return static_cast<int>(tasks_.size()); }
  const std::vector<int>& nodes(int task) const { return tasks_[at(task)].nodes; }  ///< in order
  const std::vector<int>& tasks_below(int task) const { return tasks_[at(task)].below; }
  const std::vector<int>& last_tasks() const { return last_tasks_; }  ///< below none
  /// Calls work of each task after those below it, on all cores.
  void run(const std::function<void(int task)>& work) const;

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  std::span<const int> part(const std::vector<int>& of_rows, int node) const {
    return std::span(of_rows).subspan(at(begin_[at(node)]), at(height(node)));
  }
  struct Task {
    std::vector<int> nodes, below;
  };
  void find_tasks();
  void find_waiting();

  std::vector<int> first_, begin_, rows_, order_, place_, parent_, node_of_, row_of_parent_;
  std::vector<std::vector<int>> children_;
  std::vector<std::size_t> values_;
  std::vector<Task> tasks_;
  std::vector<int> last_tasks_;
  std::size_t waiting_ = 0;
};

}  // namespace impinge
