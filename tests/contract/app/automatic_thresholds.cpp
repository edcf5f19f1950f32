// Thresholds that are lengths or speeds: a number, or the word auto, for whoever writes them.
#include <catch2/catch.hpp>

#include <sstream>

#include "engine/core/archive.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/controller/session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr const char* kRows[] = {"contact.activation_distance", "contact.restitution_threshold",
                                 "contact.max_push_out",        "simulation.sleep_speed",
                                 "simulation.sleep_time",       "response.penalty.slip_speed"};

const std::string kBodies = R"([[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [0.2, 0.2, 0.2] } }
position = [0, 0.1, 0]
)";

/// The row's value in a line of its own of a scene file.
std::string scene_with(const std::string& path, const std::string& value) {
  const std::size_t dot = path.rfind('.');
  return "[" + path.substr(0, dot) + "]\n" + path.substr(dot + 1) + " = " + value + "\n" + kBodies;
}

}  // namespace

TEST_CASE("thresholds are automatic unless a number is given, by scene, --set, script and sweep alike") {
  const TempFolder folder;
  for (const std::string path : kRows) {
    CAPTURE(path);
    const auto text = [&](const std::string& scene, const std::vector<std::string>& overrides) {
      folder.write("s.toml", scene);
      Session session(folder / "s.toml", overrides, "", {64, 64, false});
      return format_value(session.rows().find(path)->get());
    };
    CHECK(text(kBodies, {}) == "auto");
    CHECK(text(scene_with(path, "\"auto\""), {}) == "auto");
    CHECK(text(scene_with(path, "0.003"), {}) == "0.003");
    CHECK(text(scene_with(path, "0.003"), {path + "=auto"}) == "auto");
    CHECK(text(scene_with(path, "\"auto\""), {path + "=2"}) == "2");

    folder.write("s.toml", scene_with(path, "0.003"));
    folder.write("a.script", "at 1 set " + path + " auto\nat 2 set " + path + " 0.004\n");
    const Outcome ran = impinge_run(
        folder.path(), {"run", "s.toml", "--script", "a.script", "--frames", "3", "--no-images", "--out", path});
    INFO(ran.err);
    CHECK(ran.code == 0);
  }
}

TEST_CASE("other words, and numbers out of range, are refused with what is allowed") {
  const TempFolder folder;
  for (const std::string path : kRows) {
    CAPTURE(path);
    folder.write("bad.toml", scene_with(path, "\"automatic\""));
    check_refused(folder, {"check", "bad.toml"}, "bad.toml:2:", "or the word auto");
    folder.write("bad.toml", scene_with(path, "-1"));
    check_refused(folder, {"check", "bad.toml"}, "bad.toml:2:", "or the word auto");
    folder.write("s.toml", kBodies);
    check_refused(folder, {"check", "s.toml", "--set", path + "=inherit"},
                  "--set " + path + "=inherit: ", "or the word auto");
    folder.write("a.script", "at 1 set " + path + " scene\n");
    check_refused(folder, {"check", "s.toml", "--script", "a.script"}, "a.script:1:", "or the word auto");
    folder.write("a.script", "from 1 to 3 ramp " + path + " auto 0.8\n");
    check_refused(folder, {"check", "s.toml", "--script", "a.script"}, "a.script:1:", "from number to number");
  }
}

TEST_CASE("a number given as the automatic one makes the same bits") {
  // d = 0.2 m, √(g d) = 1.4007 m/s
  const TempFolder folder;
  folder.write("s.toml", kBodies);
  const auto hash = [&](const std::vector<std::string>& overrides) {
    Session session(folder / "s.toml", overrides, "", {64, 64, false});
    for (int k = 0; k < 80; ++k) session.advance();
    return session.world().record().stats.state_hash;
  };
  const double d = 3.0 / (1.0 / 0.2 + 1.0 / 0.2 + 1.0 / 0.2), v = std::sqrt(9.81 * d);
  const auto set = [](const char* path, double value) { return std::string(path) + "=" + shortest(value); };
  CHECK(hash({}) ==
        hash({set("contact.activation_distance", 2.4e-3 * d), set("contact.restitution_threshold", 4.9e-3 * v),
              set("contact.max_push_out", 0.65 * v), set("simulation.sleep_speed", 4.9e-5 * v),
              set("simulation.sleep_time", 2.4 * std::sqrt(d / 9.81))}));
  CHECK(hash({}) != hash({set("simulation.sleep_time", 0.2 * std::sqrt(d / 9.81))}));
}

TEST_CASE("what is automatic is so again in a state that is restored") {
  const TempFolder folder;
  folder.write("s.toml", kBodies);
  Session session(folder / "s.toml", {}, "", {64, 64, false});
  for (const std::string path : kRows) {
    const Parameter& row = *session.rows().find(path);
    session.advance();
    ByteWriter automatic, number;
    session.save(automatic);
    row.set(parse_value(row, "0.7"));
    session.save(number);
    ByteReader back(automatic.bytes());
    session.restore(back);
    CHECK(format_value(row.get()) == "auto");
    ByteReader forth(number.bytes());
    session.restore(forth);
    CHECK(format_value(row.get()) == "0.7");
    row.set(parse_value(row, "auto"));
  }
}

TEST_CASE("info says what automatic thresholds come to") {
  const TempFolder folder;
  folder.write("s.toml", kBodies +
                             "[[body]]\nname = \"pebble\"\nkind = \"dynamic\"\nposition = [1, 0.1, 0]\n"
                             "shape = { sphere = { radius = 0.001 } }\nrestitution = 0.5\n");
  const Outcome info = impinge_run(folder.path(), {"info", "s.toml"});
  INFO(info.out);
  CHECK(info.code == 0);
  CHECK(info.out.find("4.8e-06 to 0.00048 m") != std::string::npos);    // activation distance
  CHECK(info.out.find("0.00069 to 0.0069 m/s") != std::string::npos);   // restitution threshold
  CHECK(info.out.find("0.091 to 0.91 m/s") != std::string::npos);       // push-out
  CHECK(info.out.find("6.9e-06 to 6.9e-05 m/s") != std::string::npos);  // sleep
  const Outcome fixed = impinge_run(folder.path(), {"info", "s.toml", "--set", "contact.activation_distance=0.001"});
  CHECK(fixed.out.find("0.001 m") != std::string::npos);
  CHECK(fixed.out.find("4.8e-06 to 0.00048 m") == std::string::npos);
}
