// impinge list
#include <fmt/format.h>

#include <algorithm>

#include "engine/algebra/linear_solver.hpp"
#include "engine/bodies/body_description.hpp"
#include "engine/core/error.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "engine/ledger/frame_ledger.hpp"
#include "engine/response/response.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/shape_entry.hpp"
#include "engine/world/figures.hpp"
#include "viewer/app/listing.hpp"
#include "viewer/app/sub_command.hpp"
#include "viewer/controller/frame_view.hpp"
#include "viewer/controller/own_columns.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/preflight/preflight.hpp"
#include "viewer/report/parts.hpp"
#include "viewer/state/body_figures.hpp"
#include "viewer/sweep/reference.hpp"

namespace impinge {

namespace {

template <class Interface>
Listing listing_of(const Registry<Interface>& registry) {
  Listing list;
  for (const Entry<Interface>& e : registry) list.add({"name", "meaning"}, {std::string(e.name), std::string(e.doc)});
  return list;
}

std::string range_of(const Parameter& row) {
  const bool number =
      row.kind == ParameterKind::integer || row.kind == ParameterKind::real || row.kind == ParameterKind::vector3;
  if (number)
    return fmt::format("[{}, {}]{}", shortest(row.range.low), shortest(row.range.high),
                       row.word.empty() ? "" : " | " + row.word);
  return row.names.empty() ? "" : fmt::format("{}", fmt::join(row.names, " | "));
}

/// A deformable cube with a held node, so that all its rows exist.
BodyDescription small_deformable() {
  auto soft = std::make_shared<DeformableDescription>();
  soft->mesh = make_tet_box(Vec3::Ones(), 1, 1, 1);
  NodeRegion held;
  held.kind = NodeRegion::list;
  held.nodes = {0};
  soft->fixed = {held};
  auto surface = std::make_shared<SurfaceMesh>();
  surface->mesh = {soft->mesh.vertices, boundary_triangles(soft->mesh)};
  surface->topology = make_topology(surface->mesh);
  soft->embedding = embed(soft->mesh, surface->mesh.vertices);
  BodyDescription body;
  body.name = "DEFORMABLE";
  body.kind = BodyKind::deformable;
  body.shape = MeshPointer(surface);
  body.deformable = soft;
  return body;
}

/// All rows there can be: of a world with a body of each kind that has some, and of what a view and a preflight have.
class AllRows {
 public:
  AllRows() {
    world_.parameters.bind(rows_);
    view_.bind(rows_);
    bind_silence(rows_, silenced_);
    bind_own_columns(rows_, columns_);
    BodyDescription body;
    body.name = "NAME";
    body.shape = Sphere(1.0);
    world_.add_body(body);
    world_.add_body(small_deformable());
    world_.bind_bodies(rows_);
    // and what materials add to the one that this body has
    for (const Entry<Material>& entry : materials()) {
      ParameterSet own;
      materials_.push_back(entry.make());
      materials_.back()->declare(Rows(own, "body.DEFORMABLE.material"));
      for (const Parameter& row : own.all())
        if (rows_.find(row.path) == nullptr) rows_.add(row);
    }
  }
  AllRows(const AllRows&) = delete;
  AllRows& operator=(const AllRows&) = delete;

  const std::deque<Parameter>& all() const { return rows_.all(); }
  /// What both kinds of bodies have is shown once.
  bool is_twin(const Parameter& row) const {
    const std::string own = "body.DEFORMABLE.";
    return row.path.starts_with(own) && rows_.find("body.NAME." + row.path.substr(own.size())) != nullptr;
  }

 private:
  World world_;
  FrameView view_;
  std::vector<std::string> silenced_, columns_;
  ParameterSet rows_;
  std::vector<std::unique_ptr<Material>> materials_;
};

std::string json_list(const std::vector<std::string>& texts) {
  std::vector<std::string> quoted;
  for (const std::string& text : texts) quoted.push_back(json_text(text));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

std::string json_value(const ParameterValue& value) {
  struct Writer {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return std::to_string(v); }
    std::string operator()(double v) const { return shortest(v); }
    std::string operator()(const std::string& v) const { return json_text(v); }
    std::string operator()(const Vec3& v) const {
      return fmt::format("[{}, {}, {}]", shortest(v.x()), shortest(v.y()), shortest(v.z()));
    }
    std::string operator()(const std::vector<std::string>& v) const { return json_list(v); }
  };
  return std::visit(Writer{}, value);
}

bool is_number(const Parameter& row) {
  return row.kind == ParameterKind::integer || row.kind == ParameterKind::real || row.kind == ParameterKind::vector3;
}

Listed listed(const Parameter& row) {
  constexpr const char* kKinds[] = {"boolean", "integer", "real", "text", "choice", "vector", "list"};
  const char* kind = kKinds[static_cast<int>(row.kind)];
  const bool of_body = row.path.starts_with("body.");  // whose values are the body's
  const std::string range = range_of(row), initial = of_body ? "" : format_value(row.initial);
  Listed item;
  std::string facts = kind;
  if (!row.unit.empty()) facts += ", " + row.unit;
  if (!range.empty()) facts += ", " + range;
  if (!initial.empty()) facts += ", default " + initial;
  if (!row.live) facts += row.set ? ", set at frame 0 only" : ", fixed with the scene";
  item.rows = {{row.path, facts}, {row.doc}};
  item.json = {{"path", json_text(row.path)}, {"kind", json_text(kind)}, {"unit", json_text(row.unit)}};
  if (is_number(row)) {
    item.json.emplace_back("low", shortest(row.range.low));
    item.json.emplace_back("high", shortest(row.range.high));
  }
  if (!row.word.empty()) item.json.emplace_back("word", json_text(row.word));
  if (!row.names.empty()) item.json.emplace_back("names", json_list(row.names));
  if (!of_body) item.json.emplace_back("default", json_value(row.initial));
  item.json.emplace_back("live", row.live ? "true" : "false");
  item.json.emplace_back("meaning", json_text(row.doc));
  return item;
}

Listing list_parameters() {
  const AllRows rows;
  Listing list;
  list.layout = Listing::paragraphs;
  list.heading = {"path", "kind, unit, range, default, when it can be set if not at any time; below it the meaning"};
  for (const Parameter& row : rows.all())
    if (!rows.is_twin(row)) list.items.push_back(listed(row));
  return list;
}

Listing list_layers() {
  Listing list;
  for (const Layer& layer : layers())
    list.add({"name", "default", "meaning"},
             {std::string(layer.name), layer.on ? "on" : "off", std::string(layer.doc)});
  return list;
}

Listing list_cases() {
  Listing list;
  for (const AnalyticCase& c : analytic_cases()) list.add({"name", "meaning"}, {c.name, c.doc});
  return list;
}

Listing list_figures() {
  Listing list;
  list.heading = {"column", "unit", "number", "kind", "meaning"};
  for (const Figure& figure : figures())
    list.add(list.heading, {std::string(figure.name), std::string(figure.unit),
                            figure.is_hash()    ? "hash"
                            : figure.is_word()  ? "word"
                            : figure.is_whole() ? "whole"
                                                : "real",
                            std::string(kind_name(figure.kind)), std::string(figure.doc)});
  return list;
}

Listing list_body_figures() {
  Listing list;
  list.heading = {"call", "unit", "where", "meaning"};
  for (const BodyFigure& figure : body_figures())
    list.add(list.heading, {fmt::format("{}({})", figure.name, figure.arguments()), std::string(figure.unit),
                            !figure.in_plots()        ? "conditions"
                            : !figure.in_conditions() ? "plots"
                                                      : "everywhere",
                            std::string(figure.doc)});
  return list;
}

Listing list_sources() {
  Listing list;
  for (const LedgerSourceInfo& source : ledger_sources())
    list.add({"name", "meaning"}, {std::string(source.name), std::string(source.doc)});
  return list;
}

Listing list_shapes() {
  Listing list;
  for (const ShapeEntry& entry : shape_entries()) {
    Listed item;
    item.rows.push_back({std::string(entry.name), "", std::string(entry.doc)});
    std::vector<std::string> keys;
    for (const ShapeKey& key : entry.keys) {
      item.rows.push_back({"", std::string(key.name), fmt::format("{}; {}", unit_of(key.kind), key.doc)});
      keys.push_back(fmt::format("{{\"name\": {}, \"unit\": {}, \"required\": {}, \"meaning\": {}}}",
                                 json_text(std::string(key.name)), json_text(std::string(unit_of(key.kind))),
                                 key.required, json_text(std::string(key.doc))));
    }
    item.json = {{"name", json_text(std::string(entry.name))},
                 {"meaning", json_text(std::string(entry.doc))},
                 {"keys", fmt::format("[{}]", fmt::join(keys, ", "))}};
    list.items.push_back(std::move(item));
  }
  return list;
}

Listing list_warnings() {
  Listing list;
  for (const WarningName& warning : warning_names())
    list.add({"code", "meaning"}, {std::string(warning.code), std::string(warning.doc)});
  return list;
}

/// What there is a list of. Messages and --help name the topics in this order.
struct Topic {
  const char* name;
  Listing (*list)();
};
const std::vector<Topic> kTopics = {
    {"parameters", list_parameters},
    {"layers", list_layers},
    {"responses", [] { return listing_of(responses()); }},
    {"lcp_solvers", [] { return listing_of(lcp_solvers()); }},
    {"broad_phases", [] { return listing_of(broad_phases()); }},
    {"narrow_phases", [] { return listing_of(narrow_phases()); }},
    {"materials", [] { return listing_of(materials()); }},
    {"integrators", [] { return listing_of(integrators()); }},
    {"linear_solvers", [] { return listing_of(linear_solvers()); }},
    {"cases", list_cases},
    {"figures", list_figures},
    {"body_figures", list_body_figures},
    {"shapes", list_shapes},
    {"warnings", list_warnings},
    {"sources", list_sources},
};

std::vector<std::string> topic_names() {
  std::vector<std::string> names;
  names.reserve(kTopics.size());
  for (const Topic& topic : kTopics) names.emplace_back(topic.name);
  return names;
}

const Topic& topic_named(const std::string& name) {
  for (const Topic& topic : kTopics)
    if (name == topic.name) return topic;
  const std::string near = nearest_word(name, topic_names());
  refuse_option(fmt::format("unknown topic '{}'", name), fmt::format("allowed: {}", fmt::join(topic_names(), ", ")),
                near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
}

[[noreturn]] void refuse_filter(const std::string& filter, const std::string& topic, const Listing& all) {
  std::vector<std::string> names;
  for (const Listed& item : all.items) names.push_back(item.rows.front().front());
  const std::string near = nearest_word(filter, names);
  refuse_option(fmt::format("nothing in the list of {} holds '{}'", topic, filter),
                "part of a name or a meaning is wanted",
                near.empty() ? "leave it out to see all" : fmt::format("did you mean '{}'?", near));
}

class ListCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("TOPIC", topic_, fmt::format("{}", fmt::join(topic_names(), "|")));
    options.optional_word("FILTER", filter_, "only what holds this word in its name, range or meaning");
    options.flag("--json", json_, "for programs: an array of objects");
  }

  int run() override {
    Listing list = topic_named(topic_).list();
    if (!filter_.empty()) {
      const Listing all = list;
      list.keep(filter_);
      if (list.items.empty()) refuse_filter(filter_, topic_, all);
    }
    fmt::print("{}", json_ ? listing_json(list) : listing_text(list));
    return 0;
  }

 private:
  std::string topic_, filter_;
  bool json_ = false;
};

}  // namespace

Entry<SubCommand> list_command() {
  return entry<SubCommand, ListCommand>("list", "parameters, layers and algorithms there are");
}

}  // namespace impinge
