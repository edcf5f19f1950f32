// Pictures kept in tests/images/baselines/. IMPINGE_UPDATE_BASELINES=1 writes them anew; look at them before they are
// committed.
#include <catch2/catch.hpp>

#include <filesystem>

#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/image/difference.hpp"
#include "viewer/image/png.hpp"
#include "viewer/layers/layer.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Baseline {
  std::string name;
  Image (*paint)();
};

const std::vector<Baseline>& baselines() {
  static const std::vector<Baseline> all = {
      {"meshes", [] { return painted(sample_record(), settings_with({"meshes"})); }},
      {"contacts",
       [] {
         return painted(sample_record(), settings_with({"meshes", "contacts", "normals"}));
       }},
      {"forces",
       [] {
         return painted(sample_record(), settings_with({"meshes", "contact_forces", "gaps"}));
       }},
      {"boxes_and_pairs",
       [] {
         return painted(sample_record(), settings_with({"meshes", "aabbs", "broad_pairs"}));
       }},
      {"triangle_pairs",
       [] {
         return painted(sample_record(), settings_with({"meshes", "triangle_pairs"}));
       }},
      {"motion",
       [] {
         return painted(sample_record(), settings_with({"meshes", "velocities", "mass_centers"}));
       }},
      {"groups",
       [] {
         return painted(sample_record(), settings_with({"meshes", "groups"}));
       }},
      {"wireframe",
       [] {
         return painted(sample_record(), settings_with({"wireframe", "labels"}));
       }},
      {"moved",
       [] {
         return painted(other_record(), settings_with({"meshes", "contacts", "normals"}));
       }},
      {"floor",
       [] {
         HandMadeRecord scene;
         scene.add("floor", BodyKind::fixed, Plane{Vec3::UnitY(), 0.0}, Vec3::Zero());
         scene.add("ball", BodyKind::dynamic, Sphere{0.5}, {0, 0.5, 0});
         return painted(scene.record(), settings_with({"meshes"}), 160, 90);
       }},
      {"soft_meshes",
       [] {
         return painted(soft_record(), settings_with({"meshes", "contacts", "contact_forces"}));
       }},
      {"soft_wireframe",
       [] {
         return painted(soft_record(), settings_with({"meshes", "wireframe", "attachments"}));
       }},
      {"slides",
       [] {
         HandMadeRecord scene;
         const BodyIndex ball(scene.add("ball", BodyKind::fixed, Sphere{0.35}, {0.9, 0.2, 0})),
             bead(scene.add("bead", BodyKind::dynamic, Sphere{0.1}, {-0.9, 0.4, 0})),
             puck(scene.add("puck", BodyKind::dynamic, Box{{0.1, 0.04, 0.1}}, {0, 0.2, 0})),
             rider(scene.add("rider", BodyKind::dynamic, Sphere{0.08}, {0.9, 0.2, 0.35}));
         const Vec3 down = Vec3(1.0, -0.4, 0.0).normalized(), lean = Vec3(0.2, 1.0, 0.1).normalized();
         scene.record().attachments = {
             {"rail", bead, {}, {-0.9, 0.4, 0}, {-0.9, 0.4, 0}, Vec3::Zero(), AttachmentKind::line, down},
             {"table", puck, {}, {0, 0.2, 0}, {0, 0.2, 0}, Vec3::Zero(), AttachmentKind::plane, lean},
             {"on_ball",
              rider,
              ball,
              {0.9, 0.2, 0.35},
              {0.9, 0.2, 0.35},
              Vec3::Zero(),
              AttachmentKind::surface,
              Vec3::UnitZ()}};
         ViewSettings settings = settings_with({"meshes", "attachments"});
         settings.show_legend = true;
         return painted(scene.record(), settings, 480, 200);
       }},
      {"tetrahedra",
       [] {
         return painted(soft_record(), settings_with({"meshes", "tetrahedra"}));
       }},
      {"tetrahedra_alone", [] { return painted(soft_record(), settings_with({"tetrahedra"})); }},
      {"tetrahedra_shrunk",
       [] {
         ViewSettings settings = settings_with({"meshes", "tetrahedra"});
         set(settings, "view.tetrahedra.style", "shrunk");
         return painted(soft_record(), settings);
       }},
      {"stress",
       [] {
         ViewSettings settings = settings_with({"meshes", "stress"});
         settings.show_legend = true;
         return painted(soft_record(), settings);
       }},
      {"heat_of_speed",
       [] {
         ViewSettings settings = settings_with({"meshes", "heat"});
         settings.show_legend = true;
         return painted(sample_record(), settings);
       }},
      {"heat_of_impulses",
       [] {
         ViewSettings settings = settings_with({"meshes", "heat"});
         set(settings, "view.heat.of", "impulse");
         return painted(soft_record(), settings);
       }},
      {"heat_of_residuals",
       [] {
         StepRecord record = sample_record();
         double next = 0.0;
         for (ContactRecord& c : record.contacts) c.residual = next += 0.002;
         ViewSettings settings = settings_with({"meshes", "heat"});
         set(settings, "view.heat.of", "residual");
         settings.show_legend = true;
         return painted(record, settings);
       }},
      {"strain_of_tetrahedra",
       [] {
         ViewSettings settings = settings_with({"meshes", "tetrahedra", "strain"});
         set(settings, "view.tetrahedra.style", "shrunk");
         set(settings, "view.strain.max", "0.4");
         return painted(soft_record(), settings);
       }},
      {"fixed_nodes",
       [] {
         return painted(soft_record(), settings_with({"meshes", "fixed_nodes"}));
       }},
      {"embedding",
       [] {
         return painted(soft_record(), settings_with({"meshes", "embedding"}));
       }},
      {"soft_velocities",
       [] {
         return painted(soft_record(), settings_with({"meshes", "velocities", "mass_centers"}));
       }},
      {"clip",
       [] {
         ViewSettings settings = settings_with({"meshes", "contacts"});
         settings.clip = {true, {0.0, 0.0, 1.0}, 0.1};
         return painted(soft_record(), settings);
       }},
      {"backs_only",
       [] {
         ViewSettings settings = settings_with({"meshes"});
         settings.backs = Backs::only;
         return painted(soft_record(), settings);
       }},
      {"soft_panels",
       [] {
         ViewSettings settings = settings_with({"meshes", "stress", "fixed_nodes", "tetrahedra"});
         settings.show_figures = settings.show_legend = true;
         for (LayerSwitch& layer : settings.layers)
           layer.on = layer.on && layer.name != "meshes" && layer.name != "tetrahedra";
         return painted(soft_record(), settings, 640, 240);
       }},
      {"panels",
       [] {
         ViewSettings settings = settings_with({"contacts"});
         settings.show_figures = settings.show_legend = true;
         settings.layers.front().on = false;
         return painted(sample_record(), settings, 480, 200);
       }},
  };
  return all;
}

std::filesystem::path folder() { return std::filesystem::path(IMPINGE_SOURCE_DIR) / "tests/images/baselines"; }

}  // namespace

TEST_CASE("pictures are those of the baselines") {
  for (const Baseline& baseline : baselines()) {
    CAPTURE(baseline.name);
    const std::filesystem::path file = folder() / ("view_" + baseline.name + ".png");
    const Image now = baseline.paint();
    if (updating()) write_png(file, now);
    REQUIRE(std::filesystem::exists(file));
    const Image kept = read_png(file);
    const Difference difference = compare(kept, now);
    if (!difference.same) {
      const std::filesystem::path shown =
          std::filesystem::path(IMPINGE_BINARY_DIR) / ("view_" + baseline.name + "_difference.png");
      write_png(shown, difference_panels(kept, now, difference));
      WARN("see " << shown.string());
    }
    INFO(difference.reason);
    CHECK(difference.same);
    CHECK(std::filesystem::file_size(file) < 40'000);
  }
}

TEST_CASE("the tolerance tells all baselines apart") {
  std::vector<Image> pictures;
  for (const Baseline& baseline : baselines()) pictures.push_back(baseline.paint());
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t k = i + 1; k < pictures.size(); ++k) {
      CAPTURE(baselines()[i].name, baselines()[k].name);
      CHECK_FALSE(compare(pictures[i], pictures[k]).same);
    }
}

TEST_CASE("the tolerance sees a single mark that is missing") {
  const Image whole = painted(sample_record(), settings_with({"meshes", "contacts", "normals"}));
  StepRecord less = sample_record();
  less.contacts.pop_back();
  CHECK_FALSE(compare(whole, painted(less, settings_with({"meshes", "contacts", "normals"}))).same);
}
