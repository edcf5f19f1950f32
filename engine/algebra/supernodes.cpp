#include "engine/algebra/supernodes.hpp"

#include <algorithm>

#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr double kShare = 1.0 / 16.0;  // of all work that a task may have
constexpr double kWorthSharing = 2e6;  // operations below which waking a thread takes longer

}  // namespace

Supernodes::Supernodes(std::vector<int> first, std::vector<int> begin, std::vector<int> rows, std::vector<int> order)
    : first_(std::move(first)), begin_(std::move(begin)), rows_(std::move(rows)), order_(std::move(order)) {
  const int nodes = static_cast<int>(first_.size()) - 1;
  place_.resize(order_.size());
  for (int i = 0; i < unknowns(); ++i) place_[at(order_[at(i)])] = i;
  node_of_.resize(order_.size());
  parent_.assign(at(nodes), -1);
  children_.resize(at(nodes));
  row_of_parent_.assign(rows_.size(), -1);
  values_.assign(at(nodes) + 1, 0);
  for (int s = 0; s < nodes; ++s) {
    std::fill_n(node_of_.begin() + first_[at(s)], width(s), s);
    values_[at(s) + 1] = values_[at(s)] + at(height(s)) * at(width(s));
  }
  for (int s = 0; s < nodes; ++s) {
    if (below(s) == 0) continue;
    const std::span<const int> own = this->rows(s);
    const int parent = parent_[at(s)] = node_of(own[at(width(s))]);
    children_[at(parent)].push_back(s);
    const std::span<const int> of_parent = this->rows(parent);
    std::size_t place = 0;
    for (std::size_t i = at(width(s)); i < own.size(); ++i) {
      while (of_parent[place] != own[i]) ++place;
      row_of_parent_[at(begin_[at(s)]) + i] = static_cast<int>(place);
    }
  }
  find_tasks();
  find_waiting();
}

/// A small part of the work, and all that leads to it, is a task. So are nodes with more below them, as long as one
/// follows another: where two such rows meet, the next begins.
void Supernodes::find_tasks() {
  std::vector<double> work(at(count()));  // of a node and all below it
  double all = 0.0;
  for (int s = 0; s < count(); ++s) {
    const double own = static_cast<double>(width(s)) * height(s) * height(s);
    work[at(s)] += own;
    all += own;
    if (parent_[at(s)] >= 0) work[at(parent_[at(s)])] += work[at(s)];
  }
  if (all < kWorthSharing) {
    tasks_.emplace_back();
    for (int s = 0; s < count(); ++s) tasks_[0].nodes.push_back(s);
    last_tasks_ = {0};
    return;
  }
  const auto is_large = [&](int s) { return work[at(s)] > kShare * all; };
  std::vector<int> task(at(count()));
  const auto begin_task = [&](int s) {
    task[at(s)] = tasks();
    tasks_.emplace_back();
  };
  for (int s = count() - 1; s >= 0; --s) {
    const int parent = parent_[at(s)];
    const auto is_large_child = [&](int child) { return is_large(child); };
    const bool follows =
        parent >= 0 &&
        (!is_large(parent) ||
         (is_large(s) && 1 == std::count_if(children(parent).begin(), children(parent).end(), is_large_child)));
    if (follows) {
      task[at(s)] = task[at(parent)];
      continue;
    }
    begin_task(s);
    (parent < 0 ? last_tasks_ : tasks_[at(task[at(parent)])].below).push_back(task[at(s)]);
  }
  for (int s = 0; s < count(); ++s) tasks_[at(task[at(s)])].nodes.push_back(s);
}

void Supernodes::find_waiting() {
  std::size_t now = 0;
  const auto left = [&](int s) { return at(below(s)) * at(below(s)); };
  for (int s = 0; s < count(); ++s) {
    now += left(s);
    waiting_ = std::max(waiting_, now);
    for (const int child : children(s)) now -= left(child);
  }
}

void Supernodes::run(const std::function<void(int task)>& work) const {
  const std::function<void(const std::vector<int>&)> run_all = [&](const std::vector<int>& tasks) {
    parallel_for(tasks.size(), 1, [&](std::size_t i) {
      run_all(tasks_[at(tasks[i])].below);
      work(tasks[i]);
    });
  };
  run_all(last_tasks_);
}

}  // namespace impinge
