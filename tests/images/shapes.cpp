// Every shape on the list is drawn where it is, and as big as it is.
#include <catch2/catch.hpp>

#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/pictures/hand_made_record.hpp"
#include "tests/support/pictures/view_scenes.hpp"
#include "viewer/image/id_image.hpp"
#include "viewer/present/frame_painter.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("a pixel shows a shape where a ray through it comes to the shape's surface", "[methods]") {
  constexpr int kWidth = 96, kHeight = 72;
  FramePainter painter(kWidth, kHeight);
  Random r(71);
  for (const ShapeEntry& entry : shape_entries())
    for (int sample = 0; sample < 3; ++sample) {
      const SharedShape shape = sample_shape(r, entry);
      if (shape->as<Plane>() != nullptr) continue;
      HandMadeRecord scene;
      const Pose pose{r.rotation(), 0.2 * r.vector()};
      scene.add("body", BodyKind::dynamic, shape, pose.position, pose.rotation);
      ViewSettings settings = settings_with({"meshes"});
      settings.camera.look_at({0.5, 0.8, 3.0}, {0.0, 0.0, 0.0});
      settings.camera_given = true;
      Image image;
      IdImage ids;
      painter.paint(scene.record(), settings, image, ids);
      const Camera& camera = settings.camera;
      const Mat3 rotation = camera.view_rotation();
      const double focal = 0.5 * kHeight / std::tan(0.5 * camera.fov_deg * M_PI / 180.0);
      int wrong = 0, covered = 0;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          const Vec3 way =
              (rotation.transpose() * Vec3((x + 0.5 - 0.5 * kWidth) / focal, (0.5 * kHeight - y - 0.5) / focal, -1.0))
                  .normalized();
          // as far as the distance says that nothing is in the way, again and again
          double along = 0.0, distance = 1.0;
          for (int step = 0; step < 200 && along < 6.0 && distance > 1e-4; ++step) {
            distance = shape->signed_distance(pose.apply_inverse(camera.eye + along * way));
            along += distance;
          }
          const bool hit = distance <= 1e-4;
          covered += hit ? 1 : 0;
          wrong += hit != (ids.object_at(x, y) != nullptr) ? 1 : 0;
        }
      CAPTURE(entry.name, sample, covered, wrong);
      CHECK(covered > 80);
      // at the rim either may be: round shapes are drawn by flat facets
      CHECK(wrong <= 12 + covered / 25);
    }
}
