// Two soft cubes, one falling on the other, beside what Incremental Potential Contact prints.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "engine/core/parallel.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/median.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Size {
  int side;       // nodes
  double ipc_ms;  // printed: a step
};
constexpr Size kSizes[] = {{5, 69}, {9, 348}, {13, 1890}};
constexpr double kGap = 0.1;  // m, to fall

struct Way {
  int frames = 60;
  bool is_aligned = false;  // node over node
  std::string response;
};

double mean(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x;
  return v.empty() ? NAN : sum / static_cast<double>(v.size());
}

bool do_cubes_touch(const World& world) {
  const std::vector<ContactRecord>& all = world.record().contacts;
  return std::any_of(all.begin(), all.end(), [](const ContactRecord& c) { return c.body_a == 1 && c.body_b == 2; });
}

/// Of one size, frame by frame: the surfaces' nodes with the first response.
using Course = std::vector<std::vector<Vec3>>;

std::vector<Vec3> nodes_of(const World& world) {
  std::vector<Vec3> nodes;
  for (std::size_t i = 1; i < world.bodies().size(); ++i) {  // not the ground
    const std::vector<Vec3>& surface = world.bodies()[i].world_vertices;
    nodes.insert(nodes.end(), surface.begin(), surface.end());
  }
  return nodes;
}

/// The largest distance of two lists' nodes, m.
double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

double run(const Size& size, const Way& way, Course& first) {
  World world;
  world.parameters.simulation.frame_time = 0.01;
  world.parameters.simulation.substeps = 1;
  world.parameters.simulation.sleeping = false;
  world.parameters.contact.friction = 0.1;
  std::istringstream more = choose(world.parameters, way.response);
  if (std::string substeps; std::getline(more, substeps, ':'))
    world.parameters.simulation.substeps = std::stoi(substeps);
  world.add_body(fixed_plane("ground", Vec3::UnitY(), 0.0));
  const SoftOptions soft{.damping_beta = 0.0, .model = "neo_hookean"};
  const double aside = way.is_aligned ? 0.0 : 0.05;
  world.add_body(soft_cube("lower", 1.0, size.side - 1, Vec3::Zero(), soft));
  world.add_body(soft_cube("upper", 1.0, size.side - 1, Vec3(aside, 1.0 + kGap, aside), soft));
  world.start();

  std::vector<double> narrow, assemble, response, integrate, step, contacts;
  double overlap = 0.0, residual = 0.0, apart = 0.0;
  const bool is_first = first.empty();
  std::int64_t unconverged = 0, unsafe = 0;
  bool is_finite = true;
  for (int i = 0; i < way.frames; ++i) {
    world.step();
    const FrameStats& s = world.record().stats;
    is_finite = is_finite && std::isfinite(s.kinetic + s.potential + s.elastic);
    unconverged += s.unconverged;
    unsafe += s.unsafe_motions;
    residual = std::max(residual, s.residual_coulomb);
    overlap = std::max(overlap, judge_overlap(world.bodies()).penetration);
    const std::vector<Vec3> nodes = nodes_of(world);
    if (is_first) first.push_back(nodes);
    apart = std::max(apart, distance(nodes, first[static_cast<std::size_t>(i)]));
    if (!do_cubes_touch(world)) continue;
    narrow.push_back(s.times.broad_ms + s.times.narrow_ms);
    assemble.push_back(s.times.assemble_ms);
    response.push_back(s.times.response_ms);
    integrate.push_back(s.times.integrate_ms);
    step.push_back(s.times.step_ms);
    contacts.push_back(static_cast<double>(s.contacts));
  }
  std::printf("%-50s %6d %5zu", way.response.c_str(), 2 * size.side * size.side * size.side, step.size());
  for (const auto* v : {&narrow, &assemble, &response, &integrate, &step})
    std::printf(" %7.1f %7.1f", median(*v), mean(*v));
  std::printf(" %7.0f %6.0f %7.2f %6ld %6ld %9.1e %9.1e %9.1e %s\n", median(contacts),
              contacts.empty() ? 0.0 : *std::max_element(contacts.begin(), contacts.end()), median(step) / size.ipc_ms,
              static_cast<long>(unconverged), static_cast<long>(unsafe), residual, overlap, apart,
              is_finite ? "" : "energy is no number");
  std::fflush(stdout);
  return median(step);
}

/// In the order of the list; none if a word of it is none of them.
std::vector<Size> sizes_in(const std::string& list) {
  std::vector<Size> sizes;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    const auto at = std::find_if(std::begin(kSizes), std::end(kSizes),
                                 [&](const Size& size) { return std::to_string(size.side) == word; });
    if (at == std::end(kSizes)) return {};
    sizes.push_back(*at);
  }
  return sizes;
}

}  // namespace

int main(int argc, char** argv) {
  Way way;
  int threads = thread_count();
  std::string nodes = "5,9,13";
  std::vector<std::string> words = {"constraint_anticipation", "iterative_constraint_anticipation"};
  BenchArguments arguments(
      "bench_soft_cubes",
      "Two soft cubes, one falling on the other which lies on the ground: what Incremental Potential\n"
      "Contact is measured on in PEERS §4 (1 m, E 1e5 Pa, ν 0.4, 1000 kg/m³, h 0.01 s, one sub-step,\n"
      "friction 0.1, neo-Hookean; 250, 1,458 and 4,394 nodes in all). Milliseconds a step in which the\n"
      "cubes touch, by stage; contacts, solves without an answer, Coulomb's residual, the judge's overlap;\n"
      "`to IPC`: the median step over what is printed there; `apart`: how far a node is from where the\n"
      "first response of the list had it, the farthest of all frames. Clock time.");
  const std::vector<std::string> methods_unless_given = words;
  arguments.number("frames", way.frames, {1}, "of 10 ms");
  arguments.number("threads", threads, {1}, "how many");
  arguments.word(
      "nodes", nodes,
      [](const std::string& list) -> std::string {
        return sizes_in(list).empty() ? "5, 9 and 13, with commas between" : "";
      },
      "a side, with commas between");
  arguments.words(
      "method", words, [](const std::string& word) { return word == "aligned" ? "" : method_fault(word, "sub-steps"); },
      "response[:solver[:tolerance[:sub-steps]]], and `aligned`: node over node");
  arguments.read_or_exit(argc, argv);
  set_thread_count(threads);
  const std::vector<Size> sizes = sizes_in(nodes);
  way.is_aligned = std::erase(words, "aligned") > 0;
  if (words.empty()) words = methods_unless_given;
  std::printf(
      "%d threads; ms a step in which the cubes touch: median, mean\n%-50s %6s %5s %15s %15s %15s %15s %15s %7s "
      "%6s %7s %6s %6s %9s %9s %9s\n",
      thread_count(), "", "nodes", "steps", "detect", "assemble", "response", "integrate", "step", "contacts", "most",
      "to IPC", "open", "unsafe", "residual", "overlap m", "apart m");
  std::vector<Course> courses(sizes.size());
  for (const std::string& response : words) {
    way.response = response;
    std::vector<double> ms;
    for (std::size_t i = 0; i < sizes.size(); ++i) ms.push_back(run(sizes[i], way, courses[i]));
    for (std::size_t i = 1; i < ms.size(); ++i)
      std::printf("  growth from %d to %d nodes a side: n^%.2f\n", sizes[i - 1].side, sizes[i].side,
                  std::log(ms[i] / ms[i - 1]) / (3.0 * std::log(double(sizes[i].side) / sizes[i - 1].side)));
  }
}
