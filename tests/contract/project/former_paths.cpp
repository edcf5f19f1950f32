// Parameters under the paths of earlier versions: taken everywhere, written back under the present ones, and named once.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "engine/frozen/frozen_comparison.hpp"
#include "engine/frozen/frozen_step_file.hpp"
#include "engine/world/parameters.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"
#include "viewer/layers/layer.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr const char* kBodies = R"(
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [0.2, 0.2, 0.2] } }
material = { density = 500 }
position = [0, 0.102, 0]
velocity = [1, 0, 0]
)";

/// Every former path with a value that isn't the default, and the present ones.
struct Former {
  const char *path, *value;
  std::vector<const char*> present;
};
const std::vector<Former>& all_former() {
  static const std::vector<Former> list = {
      {"response.form", "\"seed\"", {"response.iterative_constraint_anticipation.form"}},
      {"response.stop", "\"change\"", {"response.iterative_constraint_anticipation.stop"}},
      {"response.max_iterations", "77", {"response.iterative_constraint_anticipation.max_iterations"}},
      {"response.impulse_iterations",
       "7",
       {"response.sequential_impulse.iterations", "response.simultaneous_impulse.iterations"}},
      {"response.penalty_form", "\"explicit\"", {"response.penalty.form"}},
      {"response.penalty_stiffness", "2500.5", {"response.penalty.stiffness"}},
      {"response.penalty_damping", "3.25", {"response.penalty.damping"}},
      {"response.penalty_slip_speed", "0.02", {"response.penalty.slip_speed"}},
      {"response.soft_frequency", "12.5", {"response.soft_constraint.frequency"}},
      {"response.soft_damping_ratio", "2.5", {"response.soft_constraint.damping_ratio"}},
      {"response.soft_iterations", "5", {"response.soft_constraint.iterations"}},
      {"response.soft_relax_iterations", "3", {"response.soft_constraint.relax_iterations"}},
      {"narrow_phase.volume", "\"obb\"", {"narrow_phase.bvh.volume"}},
      {"view.force_unit", "12.5", {"view.contact_forces.unit"}}};
  return list;
}

bool contains(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }
int count(const std::string& text, const std::string& words) {
  int n = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++n;
  return n;
}

/// What run.toml says of a path, "" for nothing.
std::string recorded(const std::string& toml, const std::string& path) {
  const std::size_t dot = path.rfind('.');
  std::size_t begin = toml.find("\n[" + path.substr(0, dot) + "]\n");
  if (begin == std::string::npos) return "";
  const std::string table = toml.substr(begin, toml.find("\n[", begin + 1) - begin),
                    key = "\n" + path.substr(dot + 1) + " = ";
  begin = table.find(key);
  return begin == std::string::npos
             ? ""
             : table.substr(begin + key.size(), table.find('\n', begin + 1) - begin - key.size());
}

void check_recorded(const std::string& toml) {
  for (const Former& former : all_former()) {
    CAPTURE(former.path);
    CHECK(recorded(toml, former.path) == "");
    for (const char* present : former.present) CHECK(recorded(toml, present) == former.value);
  }
}

std::string hashes(const TempFolder& folder, const std::string& run) {
  std::string text = slurp(folder / (run + "/stats.csv")), all;
  // times differ from run to run
  const std::size_t header = text.find('\n');
  std::size_t column = 0;
  for (std::size_t at = text.find("state_hash"), begin = 0; begin < at; begin = text.find(',', begin) + 1) ++column;
  for (std::size_t begin = header + 1; begin < text.size(); begin = text.find('\n', begin) + 1) {
    std::size_t at = begin;
    for (std::size_t k = 0; k < column; ++k) at = text.find(',', at) + 1;
    all += text.substr(at, 16) + "\n";
  }
  return all;
}

/// The run's answer comes out again.
void check_solved_again(const FrozenStep& step, Parameters& p) {
  ResponseContext context = response_context(p);
  context.time_step = step.time_step;
  const FrozenOutcome again = solve_frozen(step, *p.response.method, *p.lcp.method, context);
  const GroupAnswer& before = step.groups[0].answer;
  REQUIRE(again.answers[0].lambda.size() == before.lambda.size());
  for (std::size_t i = 0; i < before.lambda.size(); ++i)
    CHECK((again.answers[0].lambda[i] - before.lambda[i]).norm() <= 1e-12 * before.lambda[0].norm());
}

}  // namespace

TEST_CASE("former paths: the list has them all, and no present one") {
  const TempFolder folder;
  Parameters parameters;
  ViewSettings view = make_view_settings();
  ParameterSet rows;
  parameters.bind(rows);
  view.bind(rows);
  CHECK(rows.former_paths().size() == all_former().size());
  const Outcome list = impinge_run(folder.path(), {"list", "parameters"});
  for (const Former& former : all_former()) {
    CAPTURE(former.path);
    REQUIRE(rows.renamed(former.path) != nullptr);
    CHECK(*rows.renamed(former.path) == std::vector<std::string>(former.present.begin(), former.present.end()));
    CHECK_FALSE(contains(list.out, fmt::format("\n{} ", former.path)));
    for (const char* present : former.present) CHECK(contains(list.out, fmt::format("\n{} ", present)));
  }
}

TEST_CASE("former paths: in a scene, by --set and in a script they do what the present ones do, and are named once") {
  const TempFolder folder;
  std::string tables, by_present = kBodies;
  std::vector<std::string> set_former = {"--set", "response.method=penalty"}, set_present = set_former;
  std::string script;
  for (const Former& former : all_former()) {
    const std::string path = former.path;
    tables += fmt::format("{} = {}\n", path, former.value);
    set_former.insert(set_former.end(), {"--set", fmt::format("{}={}", path, former.value)});
    for (const char* present : former.present)
      set_present.insert(set_present.end(), {"--set", fmt::format("{}={}", present, former.value)});
    script += fmt::format("at 0 set {} {}\n", path, former.value);
  }
  folder.write("former.toml", "response.method = \"penalty\"\n" + tables + kBodies);
  folder.write("plain.toml", kBodies);
  folder.write("former.script", "at 0 set response.method penalty\n" + script);
  const auto run = [&](const char* scene, const char* out, std::vector<std::string> more) {
    std::vector<std::string> words = {"run", scene, "--frames", "10", "--no-images", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = impinge_run(folder.path(), words);
    CAPTURE(out, outcome.err);
    REQUIRE(outcome.code == 0);
    return outcome;
  };
  const Outcome present = run("plain.toml", "present", set_present);
  CHECK_FALSE(contains(present.err, "note:"));
  check_recorded(slurp(folder / "present/run.toml"));
  const std::string wanted = hashes(folder, "present");
  for (const auto& [scene, out, more] :
       {std::tuple("former.toml", "file", std::vector<std::string>{}), std::tuple("plain.toml", "set", set_former),
        std::tuple("plain.toml", "script", std::vector<std::string>{"--script", "former.script"})}) {
    const Outcome outcome = run(scene, out, more);
    CAPTURE(out, outcome.err);
    CHECK(count(outcome.err, "note: parameters have new paths: write ") == 1);
    for (const Former& former : all_former()) {
      CHECK(count(outcome.err, fmt::format(" for {}", former.path)) == 1);
      CHECK(contains(outcome.err, former.present.back()));
    }
    CHECK(hashes(folder, out) == wanted);
    if (std::string(out) != "script") check_recorded(slurp(folder / fmt::format("{}/run.toml", out)));
  }
  // what a script changed is written down as it is said today
  const std::string log = slurp(folder / "script/commands.log");
  CHECK_FALSE(contains(log, "penalty_slip_speed"));
  CHECK(contains(log, "at 0 set response.penalty.slip_speed 0.02\n"));
  CHECK(contains(log,
                 "at 0 set response.sequential_impulse.iterations 7\nat 0 set "
                 "response.simultaneous_impulse.iterations 7\n"));
  const Outcome checked = impinge_run(folder.path(), {"check", "former.toml"});
  CHECK(checked.code == 0);
  CHECK(count(checked.err, "note: parameters have new paths") == 1);

  // a run.toml of an earlier version, which has them all
  std::string old = slurp(folder / "present/run.toml");
  std::string former_rows;
  for (const Former& former : all_former()) {
    if (std::string(former.path).rfind("response.", 0) != 0) continue;
    former_rows += fmt::format("{} = {}\n", std::string(former.path).substr(9), former.value);
    for (const char* path : former.present) {
      const std::string key = std::string(path).substr(std::string(path).rfind('.') + 1);
      const std::string table = std::string(path).substr(0, std::string(path).rfind('.'));
      const std::size_t begin = old.find("\n[" + table + "]\n"), at = old.find("\n" + key + " = ", begin);
      old.erase(at, old.find('\n', at + 1) - at);
    }
  }
  old = replaced(old, "[response]\n", "[response]\n" + former_rows);
  folder.write("old/run.toml", old);
  const Outcome again =
      impinge_run(folder.path(), {"run", "old/run.toml", "--frames", "10", "--no-images", "--out", "again"});
  CAPTURE(again.err);
  REQUIRE(again.code == 0);
  CHECK(hashes(folder, "again") == wanted);
  check_recorded(slurp(folder / "again/run.toml"));
}

TEST_CASE("former paths: values are checked as ever, and a parameter by both paths is refused") {
  const TempFolder folder;
  folder.write("range.toml", std::string("response.penalty_slip_speed = -1\n") + kBodies);
  check_refused(folder, {"check", "range.toml"}, "range.toml:1:31: ", "[0, 1000]");
  folder.write("both.toml",
               std::string("[response]\npenalty_slip_speed = 1\npenalty = { slip_speed = 1 }\n") + kBodies);
  check_refused(folder, {"check", "both.toml"},
                "both.toml:2:", "response.penalty_slip_speed is the former path of response.penalty.slip_speed");
  folder.write("one.toml",
               std::string("response.sequential_impulse.iterations = 9\nresponse.impulse_iterations = 7\n") + kBodies);
  check_refused(folder, {"check", "one.toml"}, "one.toml:2:", "leave out the former path");
  folder.write("plain.toml", kBodies);
  folder.write("a.script", "at 1 set response.penalty_slip_speed 1e9\n");
  check_refused(folder, {"run", "plain.toml", "--script", "a.script", "--out", "x"}, "a.script:1:38: ", "out of range");
  // what --set says wins over the file, by whichever path either goes
  folder.write("file.toml", std::string("response.penalty_slip_speed = 0.5\n") + kBodies);
  for (const char* path : {"response.penalty_slip_speed", "response.penalty.slip_speed"}) {
    const Outcome run = impinge_run(folder.path(), {"run", "file.toml", "--set", fmt::format("{}=0.25", path),
                                                    "--frames", "1", "--no-images", "--out", path});
    REQUIRE(run.code == 0);
    CHECK(recorded(slurp(folder / fmt::format("{}/run.toml", path)), "response.penalty.slip_speed") == "0.25");
  }
  // the nearest name to a slip is a present one
  const Outcome slip = impinge_run(folder.path(), {"check", "plain.toml", "--set", "response.penalty_slip_sped=1"});
  CHECK(slip.code == 2);
  CHECK_FALSE(contains(slip.err, "did you mean 'response.penalty_slip_speed'"));
}

TEST_CASE("former paths: a sweep varies them, columns and filter included") {
  const TempFolder folder;
  folder.write("s.toml", kBodies);
  const Outcome sweep =
      impinge_run(folder.path(),
                  {"sweep", "s.toml", "--set", "response.penalty_form=explicit", "--set", "response.method=penalty",
                   "--vary", "response.penalty_slip_speed=0.001,0.01,0.1", "--vary", "response.impulse_iterations=5,6",
                   "--filter", "response.penalty_slip_speed>0.005", "--frames", "2", "--jobs", "1", "--out", "w"});
  CAPTURE(sweep.out, sweep.err);
  REQUIRE(sweep.code == 0);
  CHECK(count(sweep.err, "note: parameters have new paths") == 1);
  const std::string results = slurp(folder / "w/results.csv");
  CHECK(contains(results, "response.penalty.slip_speed"));
  CHECK_FALSE(contains(results, "penalty_slip_speed"));
  CHECK(std::count(results.begin(), results.end(), '\n') == 5);
  const std::string written = slurp(folder / "w/sweep.toml");
  CHECK(contains(written, "response.penalty.form=explicit"));
  CHECK_FALSE(contains(written, "penalty_form"));
  int found = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "w/jobs")) {
    if (entry.path().filename() != "run.toml") continue;
    ++found;
    const std::string toml = slurp(entry.path());
    CHECK(recorded(toml, "response.sequential_impulse.iterations") ==
          recorded(toml, "response.simultaneous_impulse.iterations"));
    CHECK(recorded(toml, "response.sequential_impulse.iterations") != "200");
    CHECK(recorded(toml, "response.penalty.form") == "\"explicit\"");
  }
  CHECK(found == 4);
}

TEST_CASE("former paths: a frozen step of version 2 is read, its settings under their present paths") {
  const FrozenStep step = read_frozen_step(IMPINGE_SOURCE_DIR "/tests/support/data/version_2.step");
  CHECK(step.scene == "s.toml");
  CHECK(step.frame == 3);
  CHECK(step.contacts() == 4);
  CHECK(step.bodies == std::vector<std::string>{"floor", "crate"});
  Parameters p;
  take_settings(step.settings, p);
  CHECK(p.response.method.name() == "penalty");
  CHECK(p.lcp.method.name() == "automatic");
  CHECK(p.lcp.max_iterations == 1000);
  ParameterSet rows;
  p.bind(rows);
  for (const auto& [path, value] : {std::pair("response.penalty.form", "explicit"),
                                    {"response.penalty.stiffness", "2500.5"},
                                    {"response.penalty.slip_speed", "0.002"},
                                    {"response.soft_constraint.frequency", "12.5"},
                                    {"response.iterative_constraint_anticipation.form", "seed"},
                                    {"response.sequential_impulse.iterations", "77"},
                                    {"response.simultaneous_impulse.iterations", "77"}}) {
    CAPTURE(path);
    CHECK(format_value(rows.find(path)->get()) == value);
  }
  check_solved_again(step, p);
}

TEST_CASE("a frozen step of version 3 keeps its numbers where thresholds are automatic now") {
  // a crate of 0.4 m that slides by 2 mm/s, twice the slip speed of then and almost that of now
  const FrozenStep step = read_frozen_step(IMPINGE_SOURCE_DIR "/tests/support/data/version_3.step");
  CHECK(step.frame == 3);
  CHECK(step.contacts() == 4);
  Parameters p;
  take_settings(step.settings, p);
  CHECK(p.response.method.name() == "penalty");
  ParameterSet rows;
  p.bind(rows);
  CHECK(format_value(rows.find("response.penalty.slip_speed")->get()) == "0.001");
  CHECK(format_value(rows.find("contact.activation_distance")->get()) == "0.001");
  check_solved_again(step, p);
}
