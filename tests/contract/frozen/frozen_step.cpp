// Frozen steps: what run --freeze writes is read back to the bit and solves to what the run found; damaged files are
// refused; what impinge step makes of them.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/frozen/frozen_comparison.hpp"
#include "engine/frozen/frozen_step_file.hpp"
#include "engine/io/little_endian.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr std::size_t kHead = 44;

/// A rigid cube on a deformable one on the floor, and a rigid one apart from them: two groups.
void fill(World& world, const char* response) {
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
  world.add_body(soft_cube("soft", 0.2, 2, {0, 0.001, 0}, {1e5, 0.4, 1000.0, 0.01, "corotational"}));
  world.add_body(cube("above", 0.1, {0.01, 0.252, 0.02}));
  BodyDescription apart = cube("apart", 0.1, {1.0, 0.05, 0});
  apart.velocity = {0.5, 0, 0};
  world.add_body(apart);
  world.parameters.response.method = response;
  world.parameters.simulation.substeps = 2;
  world.start();
}

FrozenStep frozen_at(int frame, const char* response = "constraint_anticipation") {
  World world;
  fill(world, response);
  run(world, frame - 1);
  return world.step_and_freeze();
}

void check_equal(const FrozenGroup& a, const FrozenGroup& b) {
  CHECK(a.rigid_bodies == b.rigid_bodies);
  CHECK(a.deformable_bodies == b.deformable_bodies);
  REQUIRE(a.matrices.size() == b.matrices.size());
  for (std::size_t s = 0; s < a.matrices.size(); ++s) {
    CHECK(a.matrices[s].pattern->begin == b.matrices[s].pattern->begin);
    CHECK(a.matrices[s].pattern->column == b.matrices[s].pattern->column);
    CHECK(a.matrices[s].pattern->diagonal == b.matrices[s].pattern->diagonal);
    CHECK(a.matrices[s].pattern->mirror == b.matrices[s].pattern->mirror);
    CHECK(a.matrices[s].values == b.matrices[s].values);
    CHECK(a.system.deformable[s].velocity == b.system.deformable[s].velocity);
    CHECK(a.system.deformable[s].displacement_velocity == b.system.deformable[s].displacement_velocity);
    CHECK(a.answer.deformable_delta[s] == b.answer.deformable_delta[s]);
  }
  REQUIRE(a.system.rigid.size() == b.system.rigid.size());
  for (std::size_t i = 0; i < a.system.rigid.size(); ++i) {
    CHECK(a.system.rigid[i].inverse_mass == b.system.rigid[i].inverse_mass);
    CHECK(a.system.rigid[i].inverse_inertia == b.system.rigid[i].inverse_inertia);
    CHECK(a.system.rigid[i].velocity == b.system.rigid[i].velocity);
    CHECK(a.system.rigid[i].angular_velocity == b.system.rigid[i].angular_velocity);
  }
  CHECK(a.system.lambda == b.system.lambda);
  CHECK(a.answer.lambda == b.answer.lambda);
  CHECK(a.answer.delta_velocity == b.answer.delta_velocity);
  CHECK(a.answer.delta_angular_velocity == b.answer.delta_angular_velocity);
  REQUIRE(a.system.contacts.size() == b.system.contacts.size());
  for (std::size_t i = 0; i < a.system.contacts.size(); ++i) {
    const ContactRows &l = a.system.contacts[i], &r = b.system.contacts[i];
    CHECK(l.directions == r.directions);
    CHECK((l.kind == r.kind && l.gap == r.gap && l.bound == r.bound && l.friction == r.friction &&
           l.restitution == r.restitution && l.velocity_before == r.velocity_before && l.surface == r.surface));
    CHECK((l.a.rigid == r.a.rigid && l.a.deformable == r.a.deformable && l.a.arm == r.a.arm && l.b.rigid == r.b.rigid &&
           l.b.deformable == r.b.deformable && l.b.arm == r.b.arm));
    REQUIRE(l.a.nodes.size() == r.a.nodes.size());
    REQUIRE(l.b.nodes.size() == r.b.nodes.size());
    for (std::size_t k = 0; k < l.a.nodes.size(); ++k)
      CHECK((l.a.nodes[k].node == r.a.nodes[k].node && l.a.nodes[k].weight == r.a.nodes[k].weight));
    for (std::size_t k = 0; k < l.b.nodes.size(); ++k)
      CHECK((l.b.nodes[k].node == r.b.nodes[k].node && l.b.nodes[k].weight == r.b.nodes[k].weight));
    const FrozenContact &p = a.geometry[i], &q = b.geometry[i];
    CHECK((p.body_a == q.body_a && p.body_b == q.body_b && p.triangle_a == q.triangle_a &&
           p.triangle_b == q.triangle_b && p.feature == q.feature));
    CHECK((p.point_a == q.point_a && p.point_b == q.point_b));
  }
}

std::string refusal(const std::filesystem::path& file) {
  try {
    read_frozen_step(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The bytes with a head that fits them.
std::string sealed(std::string bytes) {
  LittleEndianWriter head;
  head.put(std::uint64_t{bytes.size() - kHead}), head.put(fnv1a(std::string_view(bytes).substr(kHead)));
  return bytes.replace(28, 16, head.bytes());
}

constexpr const char* kScene = R"([[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [0.2, 0.2, 0.2] } }
material = { density = 500 }
position = [0, 0.15, 0]
rotation = [10, 0, 0]
velocity = [1, 0, 0]
)";

}  // namespace

TEST_CASE("a frozen step is read back to the bit, and freezing changes nothing") {
  const TempFolder folder;
  for (const auto& e : responses()) {
    const std::string response(e.name);
    CAPTURE(response);
    World plain, watched;
    fill(plain, response.c_str());
    fill(watched, response.c_str());
    run(plain, 8);
    run(watched, 7);
    const FrozenStep step = watched.step_and_freeze();
    CHECK(plain.state_hash() == watched.state_hash());
    REQUIRE(step.groups.size() == 2);
    REQUIRE(step.groups[0].system.deformable.size() == 1);
    REQUIRE(step.groups[0].system.rigid.size() == 1);
    REQUIRE(step.contacts() > 8);
    CHECK(step.contacts() == watched.record().contacts.size());
    write_frozen_step(folder / "a.step", step);
    const FrozenStep read = read_frozen_step(folder / "a.step");
    CHECK((read.frame == 8 && read.time == step.time && read.time_step == step.time_step &&
           read.gravity == step.gravity));
    CHECK(read.time + read.time_step == Approx(watched.time()));
    CHECK(read.settings == step.settings);
    CHECK(read.setting("response.method") == response);
    CHECK(read.setting("lcp.tolerance") == "1e-08");
    CHECK(read.setting("response.penalty.slip_speed") == "auto");
    CHECK(read.bodies == std::vector<std::string>{"floor", "soft", "above", "apart"});
    REQUIRE(read.groups.size() == 2);
    for (std::size_t g = 0; g < 2; ++g) check_equal(read.groups[g], step.groups[g]);
    write_frozen_step(folder / "b.step", read);
    CHECK(slurp(folder / "a.step") == slurp(folder / "b.step"));
    // what the file holds is what the frame's record shows
    std::size_t at = 0;
    for (const FrozenGroup& group : read.groups)
      for (const Vec3& lambda : group.answer.lambda) CHECK(lambda == watched.record().contacts[at++].lambda);

    // solved once more as the run did: the same to 1e-12
    Parameters settings;
    take_settings(read.settings, settings);
    const FrozenOutcome again =
        solve_frozen(read, *settings.response.method, *settings.lcp.method, response_context(settings));
    for (std::size_t g = 0; g < 2; ++g) {
      const GroupAnswer& before = step.groups[g].answer;
      double largest = 0.0;
      for (const Vec3& l : before.lambda) largest = std::max(largest, l.norm());
      for (std::size_t i = 0; i < before.lambda.size(); ++i)
        CHECK((again.answers[g].lambda[i] - before.lambda[i]).norm() <= 1e-12 * largest);
      CHECK(energy_distance(read.groups[g], again.answers[g], before) <=
            1e-12 * std::sqrt(energy_product(read.groups[g], before, before)));
    }
  }
}

TEST_CASE("a damaged frozen step is refused, with the byte and a remedy") {
  const TempFolder folder;
  const FrozenStep step = frozen_at(3);
  write_frozen_step(folder / "a.step", step);
  const std::string whole = slurp(folder / "a.step");
  REQUIRE(whole.size() > 10000);
  Random random(7);
  const auto check = [&](const std::string& bytes, const std::string& words) {
    const auto file = folder.write("b.step", bytes);
    const std::string message = refusal(file);
    CAPTURE(message, words);
    CHECK(message.rfind(file.string() + ": byte ", 0) == 0);
    CHECK(message.find(words) != std::string::npos);
    CHECK(std::count(message.begin(), message.end(), ';') == 2);
  };
  for (std::size_t length = 0; length < 100; ++length)
    check(whole.substr(0, length), length < 20 ? "no frozen step" : "ends early");
  for (int k = 0; k < 50; ++k)
    check(whole.substr(0, 100 + random.below(static_cast<int>(whole.size()) - 100)), "ends early");
  check(whole + "x", "behind its end");
  for (int k = 0; k < 200; ++k) {
    std::string bytes = whole;
    const std::size_t at = k < 60 ? static_cast<std::size_t>(k % 44)
                                  : static_cast<std::size_t>(random.below(static_cast<int>(whole.size())));
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
    check(bytes, "");
  }
  std::string other = whole;
  other[20] = 6;
  check(other, "version 6 of the format; version 2 to 5 is wanted");
  check("3\n1\n0\n", "no frozen step");
  CHECK(refusal(folder / "none.step").find("no such file") != std::string::npos);
}

TEST_CASE("a frozen step with a fitting checksum is checked all the same: read in full or refused") {
  const TempFolder folder;
  const FrozenStep step = frozen_at(3);
  write_frozen_step(folder / "a.step", step);
  const std::string whole = slurp(folder / "a.step");
  Random random(11);
  int refused = 0;
  for (int k = 0; k < 300; ++k) {
    std::string bytes = whole;
    // where the counts and indices are: near the beginning, and among the contacts near the end
    const int near = std::min(4000, static_cast<int>(whole.size() - kHead) - 8);
    const std::size_t at =
        k % 3 == 0   ? kHead + static_cast<std::size_t>(random.below(near))
        : k % 3 == 1 ? whole.size() - 8 - static_cast<std::size_t>(random.below(near))
                     : kHead + static_cast<std::size_t>(random.below(static_cast<int>(whole.size() - kHead) - 8));
    switch (random.below(4)) {
      case 0:
        bytes.replace(at, 4, "\xff\xff\xff\xff", 4);
        break;
      case 1:
        bytes.replace(at, 4, "\xff\xff\xff\x7f", 4);
        break;
      case 2:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      default:
        bytes.erase(at, static_cast<std::size_t>(1 + random.below(8)));
        break;
    }
    const std::string message = refusal(folder.write("b.step", sealed(bytes)));
    refused += !message.empty();
    if (!message.empty()) CHECK(message.find(": byte ") != std::string::npos);
  }
  CHECK(refused > 100);
}

TEST_CASE("impinge run --freeze and impinge step: files, columns, figures") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const Outcome ran = impinge_run(
      folder.path(), {"run", "s.toml", "--frames", "12", "--freeze", "12", "--no-images", "--contacts", "--out", "r"});
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  CHECK(ran.out.find("r/frozen/000012.step") != std::string::npos);
  const FrozenStep step = read_frozen_step(folder / "r/frozen/000012.step");
  CHECK(step.scene == "s.toml");
  REQUIRE(step.contacts() >= 2);
  // contacts.csv of that frame has the same contacts and impulses
  const std::string contacts = slurp(folder / "r/contacts.csv");
  for (const Vec3& l : step.groups[0].answer.lambda)
    CHECK(contacts.find(fmt::format(",{},{},{},0.3,", l.x(), l.y(), l.z())) != std::string::npos);

  const Outcome solved = impinge_run(folder.path(), {"step", "r/frozen/000012.step", "--out", "result"});
  CAPTURE(solved.out, solved.err);
  REQUIRE(solved.code == 0);
  CHECK(solved.out.find("pivoting does not apply") != std::string::npos);
  const std::string methods = slurp(folder / "result/methods.csv");
  CHECK(methods.rfind("method,iterations,ms,residual,stop_reason,", 0) == 0);
  for (const Entry<Response>& response : responses())
    CHECK(methods.find(fmt::format("\n{}", response.name)) != std::string::npos);
  for (const char* solver : {"projected_gauss_seidel", "nonsmooth_nonlinear_conjugate_gradient",
                             "accelerated_projected_gradient", "semismooth_newton"}) {
    const std::string method = fmt::format("constraint_anticipation-{}", solver);
    CHECK(methods.find("\n" + method + ",") != std::string::npos);
    const std::string solution = slurp(folder / ("result/solution_" + method + ".csv"));
    CHECK(solution.rfind("contact,group,body_a,body_b,mu,r_n,r_t1,r_t2\n0,0,floor,crate,0.3,", 0) == 0);
    CHECK(static_cast<std::size_t>(std::count(solution.begin(), solution.end(), '\n')) == step.contacts() + 1);
    CHECK(slurp(folder / ("result/history_" + method + ".csv")).rfind("iteration,residual\n0,", 0) == 0);
  }
  CHECK(slurp(folder / "result/work_precision.csv")
            .rfind("method,iterations_allowed,ms,residual,distance_to_exact\n", 0) == 0);
  for (const char* picture : {"history.png", "work_precision.png"})
    CHECK(slurp(folder / "result" / picture).rfind("\x89PNG", 0) == 0);

  const Outcome one = impinge_run(folder.path(), {"step", "r/frozen/000012.step", "--response",
                                                  "constraint_anticipation", "--lcp", "semismooth_newton"});
  CHECK(one.code == 0);
  CHECK(one.out.find("projected_gauss_seidel  ") == std::string::npos);

  const Outcome early =
      impinge_run(folder.path(), {"run", "s.toml", "--frames", "1", "--freeze", "1", "--no-images", "--out", "none"});
  CHECK(early.code == 0);  // nothing touches yet: an empty step, which there is nothing to solve in
  CHECK(early.out.find("0 contacts") != std::string::npos);
  std::string damaged = slurp(folder / "r/frozen/000012.step");
  damaged[200] = static_cast<char>(damaged[200] ^ 4);
  folder.write("damaged.step", damaged);
  check_refused(folder, {"step", "none/frozen/000001.step"}, "none/frozen/000001.step: ", "has no contacts");
  check_refused(folder, {"step", "damaged.step"}, "damaged.step: byte 36: ", "checksum");
  check_refused(folder, {"step", "r/frozen/000012.step", "--response", "constraint_anticipations"},
                "command line: ", "did you mean 'constraint_anticipation'?");
  check_refused(folder, {"step", "r/frozen/000012.step", "--lcp", "pivoting"},
                "r/frozen/000012.step: ", "no chosen solver applies");
  check_refused(folder, {"run", "s.toml", "--frames", "5", "--freeze", "6", "--out", "x"},
                "command line: --freeze is 6", "from 1 to 5");
  check_refused(folder, {"run", "s.toml", "--frames", "5", "--freeze", "0", "--out", "x"},
                "command line: --freeze is 0", "frame 0 has no response");
  check_refused(folder, {"run", "s.toml", "--freeze", "-1", "--out", "x"}, "command line: ", "--freeze");
}

TEST_CASE("a frozen step that nothing solves to finite figures: a row with the reason each, and exit code 3") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--frames", "12", "--freeze", "12", "--no-images", "--out", "r"})
              .code == 0);
  const FrozenStep good = read_frozen_step(folder / "r/frozen/000012.step");
  // finite numbers all of them, as the reader wants it, that overflow in whatever is made of them
  for (int kind = 0; kind < 4; ++kind) {
    FrozenStep step = good;
    RigidBlock& body = step.groups[0].system.rigid[0];
    if (kind == 0) body.velocity = Vec3::Constant(1.5e308);
    if (kind == 1) body.inverse_mass = 1e308, body.velocity *= 1e200;
    if (kind == 2) body.inverse_inertia = 1e308 * Mat3::Identity();
    if (kind == 3)
      for (ContactRows& rows : step.groups[0].system.contacts) rows.bound = -1.7e308, rows.a.arm *= 1e300;
    CAPTURE(kind);
    const FrozenRuler ruler(step);
    write_frozen_step(folder / "bad.step", step);
    const Outcome solved = impinge_run(folder.path(), {"step", "bad.step", "--out", fmt::format("result{}", kind)});
    CAPTURE(solved.out, solved.err, ruler.unsolved());
    const std::string methods = slurp(folder / fmt::format("result{}/methods.csv", kind));
    CAPTURE(methods);
    for (const Entry<Response>& response : responses())
      CHECK(methods.find(fmt::format("\n{}", response.name)) != std::string::npos);
    CHECK(methods.find("nan") == std::string::npos);
    CHECK(methods.find("inf,") == std::string::npos);
    if (kind == 0) CHECK_FALSE(ruler.unsolved().empty());
    if (ruler.unsolved().empty()) continue;
    CHECK(solved.code == 3);
    CHECK(solved.error_lines() == 1);
    CHECK(solved.err.rfind("diverged: bad.step: frame 12: no method reaches a finite residual; ", 0) == 0);
    CHECK(solved.err.find("body 'crate': ") != std::string::npos);
    CHECK(solved.out.find("exact solution: none of group 0: ") != std::string::npos);
    CHECK(methods.find("is not finite") != std::string::npos);
    for (const auto& entry : std::filesystem::directory_iterator(folder / fmt::format("result{}", kind)))
      CHECK(entry.path().filename().string().rfind("solution_", 0) != 0);
  }
}
