// The pairs of bodies that the broad phase hands on or that have contacts: what each has, and what it costs.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "viewer/panels/debug/outliner.hpp"

namespace impinge {
namespace {

constexpr std::size_t kPairColumns = 6;

struct Pair {
  BodyIndex a, b;
  int contacts = 0, triangle_pairs = 0, deepest_contact = -1;
  double deepest = kNone, impulse = 0.0;
};

std::vector<Pair> pairs_of(const StepRecord& record) {
  std::map<std::pair<BodyIndex, BodyIndex>, Pair> all;
  const auto pair = [&](BodyIndex a, BodyIndex b) -> Pair& {
    Pair& p = all[{a, b}];
    p.a = a, p.b = b;
    return p;
  };
  for (const BodyPair& p : record.broad_pairs) pair(p.a, p.b);
  for (const TrianglePair& t : record.triangle_pairs) ++pair(t.a, t.b).triangle_pairs;
  for (std::size_t i = 0; i < record.contacts.size(); ++i) {
    const ContactRecord& c = record.contacts[i];
    Pair& p = pair(c.body_a, c.body_b);
    ++p.contacts;
    p.impulse += c.lambda.x();
    if (!(p.deepest <= c.gap)) p.deepest = c.gap, p.deepest_contact = static_cast<int>(i);
  }
  std::vector<Pair> list;
  for (const auto& [bodies, p] : all) list.push_back(p);
  return list;
}

}  // namespace

const Table& pairs_table() {
  using C = TableColumn;
  static const Table table = {
      "pairs",
      {{"a", "A", "", C::words, 6, true, "the body that stands earlier in the scene"},
       {"b", "B", "", C::words, 6, true, "the other body, or the same of one that touches itself"},
       {"contacts", "cont.", "", C::whole, 4, true, "contacts between the two"},
       {"triangle_pairs", "tri.", "", C::whole, 4, true, "pairs of triangles that were tested: what the pair costs"},
       {"gap", "gap", "m", C::number, 0, true, "the least of their contacts' gaps; negative: they overlap"},
       {"force", "force", "N", C::number, 0, false, "sum of their contacts' normal forces, last sub-step"}}};
  return table;
}

TableRows pair_rows(const DebugModel& model) {
  const StepRecord& record = *model.record;
  TableRows rows;
  const std::vector<Pair> pairs = pairs_of(record);
  const double step = substep_time(record);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair& p = pairs[i];
    const double row[kPairColumns] = {static_cast<double>(p.a.value()),
                                      static_cast<double>(p.b.value()),
                                      static_cast<double>(p.contacts),
                                      static_cast<double>(p.triangle_pairs),
                                      p.deepest,
                                      step > 0.0 && p.contacts > 0 ? p.impulse / step : kNone};
    rows.numbers.insert(rows.numbers.end(), std::begin(row), std::end(row));
    if (is_sought(model, name_of(model, p.a)) || is_sought(model, name_of(model, p.b))) rows.shown.push_back(i);
  }
  rows.words = [&model, pairs](std::size_t row, std::size_t column) {
    return name_of(model, column == 0 ? pairs[row].a : pairs[row].b);
  };
  rows.name = [&model, pairs](std::size_t row) {
    return name_of(model, pairs[row].a) + "," + name_of(model, pairs[row].b);
  };
  rows.select = [&model, pairs](std::size_t row) {
    return pairs[row].deepest_contact >= 0 ? fmt::format("select contact {}", pairs[row].deepest_contact)
                                           : "select body " + name_of(model, pairs[row].b);
  };
  rows.tip = [&model, pairs](std::size_t row) {
    return fmt::format("{} and {}; a click selects their deepest contact", name_of(model, pairs[row].a),
                       name_of(model, pairs[row].b));
  };
  const Selection& s = model.selection;
  const std::vector<BodyIndex> selected = selected_bodies(model);
  rows.is_selected = [&s, pairs, selected](std::size_t row) {
    return s.kind == Selection::contact && s.is_there() && pairs[row].a == selected.front() &&
           pairs[row].b == selected.back();
  };
  rows.is_dim = [pairs](std::size_t row) { return pairs[row].contacts == 0; };
  return rows;
}

}  // namespace impinge
