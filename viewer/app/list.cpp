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
#include "engine/response/response.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/shape_entry.hpp"
#include "engine/world/figures.hpp"
#include "viewer/app/sub_command.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/sweep/reference.hpp"

namespace impinge {

namespace {

using Row = std::vector<std::string>;

// characters, not bytes: units hold some beyond ASCII
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

void print_table(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 < row.size()) line += std::string(widths[i] - width(row[i]) + 2, ' ');
    }
    fmt::print("{}\n", line);
  }
}

template <class Interface>
void print_registry(const Registry<Interface>& registry) {
  std::vector<Row> rows;
  for (const Entry<Interface>& e : registry) rows.push_back({std::string(e.name), std::string(e.doc)});
  print_table(rows);
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

void print_parameters() {
  constexpr const char* kKinds[] = {"boolean", "integer", "real", "text", "choice", "vector", "list"};
  // a world with a body of each kind that has rows, so that those are shown as well
  World world;
  FrameView view;
  ParameterSet rows;
  world.parameters.bind(rows);
  view.bind(rows);
  BodyDescription body;
  body.name = "NAME";
  body.shape = Sphere(1.0);
  world.add_body(body);
  world.add_body(small_deformable());
  world.bind_bodies(rows);
  // and what materials add to the one that this body has
  std::vector<std::unique_ptr<Material>> all;
  for (const Entry<Material>& entry : materials()) {
    ParameterSet own;
    all.push_back(entry.make());
    all.back()->declare(Rows(own, "body.DEFORMABLE.material"));
    for (const Parameter& row : own.all())
      if (rows.find(row.path) == nullptr) rows.add(row);
  }
  std::vector<Row> table = {{"path", "kind", "unit", "range", "default", "meaning"}};
  for (const Parameter& row : rows.all()) {
    const bool of_body = row.path.rfind("body.", 0) == 0;
    // what both have is shown once
    const std::string own = "body.DEFORMABLE.";
    if (row.path.rfind(own, 0) == 0 && rows.find("body.NAME." + row.path.substr(own.size())) != nullptr) continue;
    table.push_back({row.path, kKinds[static_cast<int>(row.kind)], row.unit, range_of(row),
                     of_body ? "" : format_value(row.initial), row.doc});
  }
  print_table(table);
}

void print_layers() {
  std::vector<Row> rows;
  for (const Layer& layer : layers())
    rows.push_back({std::string(layer.name), layer.on ? "on" : "off", std::string(layer.doc)});
  print_table(rows);
}

void print_cases() {
  std::vector<Row> rows;
  for (const AnalyticCase& c : analytic_cases()) rows.push_back({c.name, c.doc});
  print_table(rows);
}

void print_figures() {
  std::vector<Row> rows = {{"column", "unit", "number", "kind", "meaning"}};
  for (const Figure& figure : figures())
    rows.push_back({std::string(figure.name), std::string(figure.unit),
                    figure.is_hash()    ? "hash"
                    : figure.is_word()  ? "word"
                    : figure.is_whole() ? "whole"
                                        : "real",
                    std::string(kind_name(figure.kind)), std::string(figure.doc)});
  print_table(rows);
}

void print_shapes() {
  std::vector<Row> rows;
  for (const ShapeEntry& entry : shape_entries()) {
    rows.push_back({std::string(entry.name), "", std::string(entry.doc)});
    for (const ShapeKey& key : entry.keys)
      rows.push_back({"", std::string(key.name), fmt::format("{}; {}", unit_of(key.kind), key.doc)});
  }
  print_table(rows);
}

/// What there is a list of. Messages and --help name the topics in this order.
struct Topic {
  const char* name;
  void (*print)();
};
const std::vector<Topic> kTopics = {
    {"parameters", print_parameters},
    {"layers", print_layers},
    {"responses", [] { print_registry(responses()); }},
    {"lcp_solvers", [] { print_registry(lcp_solvers()); }},
    {"broad_phases", [] { print_registry(broad_phases()); }},
    {"narrow_phases", [] { print_registry(narrow_phases()); }},
    {"materials", [] { print_registry(materials()); }},
    {"integrators", [] { print_registry(integrators()); }},
    {"linear_solvers", [] { print_registry(linear_solvers()); }},
    {"cases", print_cases},
    {"figures", print_figures},
    {"shapes", print_shapes},
};

std::vector<std::string> topic_names() {
  std::vector<std::string> names;
  names.reserve(kTopics.size());
  for (const Topic& topic : kTopics) names.emplace_back(topic.name);
  return names;
}

class ListCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("TOPIC", topic_, fmt::format("{}", fmt::join(topic_names(), "|")));
  }

  int run() override {
    for (const Topic& topic : kTopics)
      if (topic_ == topic.name) return topic.print(), 0;
    const std::string near = nearest_word(topic_, topic_names());
    refuse_option(fmt::format("unknown topic '{}'", topic_), fmt::format("allowed: {}", fmt::join(topic_names(), ", ")),
                  near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
  }

 private:
  std::string topic_;
};

}  // namespace

Entry<SubCommand> list_command() {
  return entry<SubCommand, ListCommand>("list", "parameters, layers and algorithms there are");
}

}  // namespace impinge
