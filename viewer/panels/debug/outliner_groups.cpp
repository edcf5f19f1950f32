// The collision groups: what is solved together.
#include <fmt/format.h>

#include <algorithm>

#include "viewer/panels/debug/outliner.hpp"

namespace impinge {
namespace {

constexpr std::size_t kGroupColumns = 7;

struct Group {
  int contacts = 0, unknowns = 0;
  double deepest = kNone, impulse = 0.0, lightest = kNone, heaviest = kNone;
};

std::vector<Group> groups_of(const StepRecord& record) {
  std::vector<Group> all(record.groups.size());
  for (std::size_t g = 0; g < all.size(); ++g)
    for (const BodyIndex b : record.groups[g]) {
      const BodyRecord& body = record.bodies[static_cast<std::size_t>(b.value())];
      all[g].unknowns += body.deformable != nullptr ? body.deformable->dofs() : body.kind == BodyKind::dynamic ? 6 : 0;
      if (!(body.mass > 0.0)) continue;
      if (!(all[g].lightest <= body.mass)) all[g].lightest = body.mass;
      if (!(all[g].heaviest >= body.mass)) all[g].heaviest = body.mass;
    }
  for (const ContactRecord& c : record.contacts) {
    if (c.group.is_none() || c.group.value() >= static_cast<int>(all.size())) continue;
    Group& group = all[static_cast<std::size_t>(c.group.value())];
    ++group.contacts;
    group.impulse += c.lambda.x();
    if (!(group.deepest <= c.gap)) group.deepest = c.gap;
  }
  return all;
}

/// "crate, ball" or "crate and 3 more".
std::string members(const DebugModel& model, std::size_t group) {
  const std::vector<BodyIndex>& bodies = model.record->groups[group];
  if (bodies.empty()) return "";
  if (bodies.size() == 1) return name_of(model, bodies[0]);
  if (bodies.size() == 2) return name_of(model, bodies[0]) + ", " + name_of(model, bodies[1]);
  return fmt::format("{} +{}", name_of(model, bodies[0]), bodies.size() - 1);
}

/// One that can move: a floor has part in many groups.
BodyIndex first_of(const DebugModel& model, std::size_t group) {
  const std::vector<BodyIndex>& bodies = model.record->groups[group];
  const auto it = std::find_if(bodies.begin(), bodies.end(), [&](BodyIndex b) {
    return model.record->bodies[static_cast<std::size_t>(b.value())].mass > 0.0;
  });
  return it == bodies.end() ? bodies.front() : *it;
}

bool is_listed(const DebugModel& model, const std::vector<BodyIndex>& bodies) {
  return std::any_of(bodies.begin(), bodies.end(), [&](BodyIndex b) { return is_sought(model, name_of(model, b)); });
}

}  // namespace

const Table& groups_table() {
  using C = TableColumn;
  static const Table table = {
      "groups",
      {{"members", "bodies", "", C::words, 9, true, "the first of its bodies, and how many more"},
       {"bodies", "n", "", C::whole, 4, true, "how many bodies"},
       {"contacts", "cont.", "", C::whole, 4, true, "contacts that are solved together"},
       {"gap", "gap", "m", C::number, 0, true, "the least of its contacts' gaps; negative: they overlap"},
       {"unknowns", "DoF", "", C::whole, 4, false, "degrees of freedom of its bodies"},
       {"mass_ratio", "m:m", "", C::number, 0, false, "its heaviest body's mass by its lightest's"},
       {"force", "force", "N", C::number, 0, false, "sum of its contacts' normal forces, last sub-step"}}};
  return table;
}

TableRows group_rows(const DebugModel& model) {
  const StepRecord& record = *model.record;
  TableRows rows;
  const std::vector<Group> groups = groups_of(record);
  const double step = substep_time(record);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const double row[kGroupColumns] = {static_cast<double>(g),
                                       static_cast<double>(record.groups[g].size()),
                                       static_cast<double>(groups[g].contacts),
                                       groups[g].deepest,
                                       static_cast<double>(groups[g].unknowns),
                                       groups[g].heaviest / groups[g].lightest,
                                       step > 0.0 ? groups[g].impulse / step : kNone};
    rows.numbers.insert(rows.numbers.end(), std::begin(row), std::end(row));
    if (is_listed(model, record.groups[g])) rows.shown.push_back(g);
  }
  rows.words = [&](std::size_t row, std::size_t) { return members(model, row); };
  rows.name = [](std::size_t row) { return fmt::format("{}", row); };
  rows.select = [&](std::size_t row) { return "select body " + name_of(model, first_of(model, row)); };
  rows.tip = [&](std::size_t row) { return fmt::format("group {}: {}", row, members(model, row)); };
  const std::vector<BodyIndex> selected = selected_bodies(model);
  rows.is_selected = [&model, selected](std::size_t row) {
    const std::vector<BodyIndex>& group = model.record->groups[row];
    return std::any_of(selected.begin(), selected.end(),
                       [&](BodyIndex b) { return std::find(group.begin(), group.end(), b) != group.end(); });
  };
  rows.is_dim = [](std::size_t) { return false; };
  return rows;
}

}  // namespace impinge
