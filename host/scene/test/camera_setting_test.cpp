#include <gtest/gtest.h>

#include "host/scene/camera.h"

namespace raygate {
namespace {

const std::vector<CameraSetting> kPath{
    {{0, 0, 10}, {0, 0, 0}, std::nullopt, 30.0},
    {{5, 2, 8}, {0, 1, 0}, glm::dvec3(0, 2, 0), std::nullopt},
    {{9, 0, 0}, {1, 0, 0}, std::nullopt, 60.0},
};

TEST(CameraPath, PassesItsPlaces) {
  for (std::size_t i = 0; i < kPath.size(); ++i) {
    const CameraSetting camera = camera_at(kPath, static_cast<double>(i) / 2.0, 40.0);
    EXPECT_EQ(camera.eye, kPath[i].eye);
    EXPECT_EQ(camera.target, kPath[i].target);
    EXPECT_EQ(camera.fov, kPath[i].fov.value_or(40.0));
  }
  EXPECT_EQ(camera_at(kPath, -1.0, 40.0).eye, kPath.front().eye);
  EXPECT_EQ(camera_at(kPath, 2.0, 40.0).eye, kPath.back().eye);
}

TEST(CameraPath, IsSmoothAndInProportion) {
  EXPECT_EQ(camera_at(kPath, 0.25, 40.0).fov, 35.0);
  EXPECT_EQ(camera_at(kPath, 0.25, 40.0).up, glm::dvec3(0, 1, 0));
  constexpr double kStep = 1e-6;
  const auto eye = [](double time) { return camera_at(kPath, time, 40.0).eye; };
  const glm::dvec3 before = (eye(0.5) - eye(0.5 - kStep)) / kStep;
  const glm::dvec3 after = (eye(0.5 + kStep) - eye(0.5)) / kStep;
  EXPECT_LT(glm::length(before - after), 1e-3) << "no kink at the middle place";
  EXPECT_GT(glm::length(before), 1.0);
}

TEST(CameraPath, TwoPlacesAreAStraightLine) {
  const std::vector<CameraSetting> line{kPath[0], kPath[2]};
  const CameraSetting middle = camera_at(line, 0.5, 40.0);
  EXPECT_EQ(middle.eye, glm::dvec3(4.5, 0, 5));
  EXPECT_EQ(middle.fov, 45.0);
  EXPECT_FALSE(middle.up);
}

TEST(CameraPath, TurnsAroundTheTarget) {
  const CameraSetting camera{{3, 5, 9}, {3, 4, 7}, glm::dvec3(0, 1, 0), 50.0};
  const CameraSetting quarter = orbited(camera, 0.25);
  EXPECT_NEAR(quarter.eye.x, 5.0, 1e-12) << "from +z to +x";
  EXPECT_NEAR(quarter.eye.y, 5.0, 1e-12);
  EXPECT_NEAR(quarter.eye.z, 7.0, 1e-12);
  EXPECT_EQ(quarter.target, camera.target);
  EXPECT_EQ(quarter.fov, 50.0);
  EXPECT_EQ(orbited(camera, 0.0).eye, camera.eye);
  EXPECT_NEAR(glm::length(orbited(camera, 1.0).eye - camera.eye), 0.0, 1e-12);
}

}  // namespace
}  // namespace raygate
