#include "host/scene/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/scene/view.h"

namespace raygate {
namespace {

TEST(ScaledDirection, HasItsLargestComponentBetweenOneAndTwo) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 100000; ++round) {
    const double scale = std::ldexp(1.0, static_cast<int>(random() % 1000) - 500);
    const glm::dvec3 direction = scale * glm::dvec3(normal(random), normal(random), normal(random));
    const glm::vec3 scaled = scaled_direction(direction);
    ASSERT_GE(largest(scaled), 1.0f);
    ASSERT_LT(largest(scaled), 2.0f);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(scaled[axis] < 0, direction[axis] < 0);
      ASSERT_NEAR(scaled[axis] * direction.x, scaled.x * direction[axis], 1e-6 * scale * 10);
    }
  }
}

TEST(ScaledDirection, ChangesNothingButTheExponent) {
  EXPECT_EQ(scaled_direction({0, -1, 0}), glm::vec3(0, -1, 0));
  EXPECT_EQ(scaled_direction({3, 5, 7}), glm::vec3(0.75f, 1.25f, 1.75f));
  // Rounds to 2 as a float.
  EXPECT_EQ(scaled_direction({1.9999999999, 0.5, 0}), glm::vec3(1, 0.25f, 0));
}

TEST(LookAt, ShowsTheTargetInTheMiddle) {
  const Camera camera = Camera::look_at({.eye = {1, 2, 3}, .target = {1, 2, -7}, .fov = 90}, 2);
  EXPECT_EQ(camera.eye(), glm::vec3(1, 2, 3));
  EXPECT_EQ(camera.direction(0.5, 0.5), glm::vec3(0, 0, -1));
  EXPECT_EQ(camera.forward(), glm::dvec3(0, 0, -1));
  EXPECT_EQ(camera.right(), glm::dvec3(1, 0, 0));
  EXPECT_EQ(camera.up(), glm::dvec3(0, 1, 0));
  // Half heights are tan(45 degrees) = 1, half widths twice that; y = 0 is the upper edge.
  const auto expect_near = [](const glm::vec3& a, const glm::vec3& b) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], 1e-6);
  };
  expect_near(camera.direction(0.5, 0) / -camera.direction(0.5, 0).z, {0, 1, -1});
  expect_near(camera.direction(1, 1) / -camera.direction(1, 1).z, {2, -1, -1});
  expect_near(camera.direction(0, 0) / -camera.direction(0, 0).z, {-2, 1, -1});
}

TEST(LookAt, AxesAreOrthonormalAndRightHanded) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
  for (int round = 0; round < 1000; ++round) {
    const Camera camera = Camera::look_at({vector(), vector(), 1e-200 * vector(), 40}, 1);
    EXPECT_NEAR(glm::length(camera.right()), 1, 1e-12);
    EXPECT_NEAR(glm::length(camera.up()), 1, 1e-12);
    EXPECT_NEAR(glm::length(camera.forward()), 1, 1e-12);
    EXPECT_NEAR(glm::dot(glm::cross(camera.right(), camera.up()), camera.forward()), -1, 1e-12);
  }
}

TEST(LookAt, RefusesWhatMakesNoPicture) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const glm::dvec3 eye(0, 0, 5), target(0), up(0, 1, 0);
  const auto look = [](const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& upwards) {
    (void)Camera::look_at({from, to, upwards}, 1.0);
  };
  EXPECT_NO_THROW(look(eye, target, up));
  EXPECT_THROW(look(eye, eye, up), InputError);
  EXPECT_THROW(look(eye, target, {0, 0, 0}), InputError);
  EXPECT_THROW(look(eye, target, {0, 0, -3}), InputError);
  EXPECT_THROW(look(eye, target, {0, nan, 0}), InputError);
  EXPECT_THROW(look(eye, {nan, 0, 0}, up), InputError);
  EXPECT_THROW(look({1e300, 0, 0}, target, up), InputError);
  EXPECT_THROW(look({-1.7e308, 0, 0}, {1.7e308, 0, 0}, up), InputError);
}

TEST(Frame, TakesAFlatScene) {
  Scene scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  scene.triangles.emplace_back().vertices = {0, 1, 2};
  EXPECT_GT(front_camera(scene, 1.5).eye().y, 0.0f) << "seen from above";
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_GT(front_camera(scene, 1.5).eye().z, 0.0f);
  scene.positions = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_NO_THROW((void)front_camera(scene, 1.5));
}

TEST(Frame, RefusesNothingToSeeAndTooMuch) {
  Scene scene;
  EXPECT_THROW((void)front_camera(scene, 1), InputError);
  const float huge = std::numeric_limits<float>::max();
  scene.positions = {{-huge, 0, 0}, {huge, 0, 0}, {0, huge, 0}};
  scene.triangles.emplace_back().vertices = {0, 1, 2};
  EXPECT_THROW((void)front_camera(scene, 1), InputError);
}

/// A camera at (1, 2, 3) that looks along -z; target at distance 4; images twice as wide as high.
Camera through(const LensSetting& lens) {
  CameraSetting setting{{1, 2, 3}, {1, 2, -1}, std::nullopt, 90.0};
  setting.lens = lens;
  return Camera::look_at(setting, 2.0);
}

/// Returns the point of a ray at this z.
glm::dvec3 at_depth(const Ray& ray, double z) {
  const glm::dvec3 origin(ray.origin), way(ray.direction);
  return origin + (z - origin.z) / way.z * way;
}

TEST(Lens, WithoutOneRaysArePinholes) {
  const Camera camera = through({});
  EXPECT_TRUE(camera.is_pinhole());
  const Ray ray = camera.ray(0.3, 0.1, {0.7, 0.2});
  EXPECT_EQ(ray.origin, camera.eye());
  EXPECT_EQ(ray.direction, camera.direction(0.3, 0.1));
}

TEST(Lens, OrthographicRaysAreAsFarApartAsAtTheTarget) {
  const Camera pinhole = through({}), camera = through({Projection::kOrthographic, {}, {}});
  EXPECT_FALSE(camera.is_pinhole());
  for (const auto& [x, y] : {std::pair(0.5, 0.5), {0.0, 0.0}, {0.9, 0.3}}) {
    const Ray ray = camera.ray(x, y, {0.0, 0.0});
    EXPECT_EQ(ray.direction, glm::vec3(0, 0, -1));
    EXPECT_EQ(ray.origin.z, 3.0f);
    const glm::dvec3 seen = at_depth(pinhole.ray(x, y, {0.0, 0.0}), -1.0);
    EXPECT_NEAR(glm::length(at_depth(ray, -1.0) - seen), 0.0, 1e-6);
  }
}

TEST(Lens, RaysOfAPointMeetWhereItIsInFocus) {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    const Camera camera = through({projection, 0.25, 7.0});
    EXPECT_FALSE(camera.is_pinhole());
    const Ray middle = camera.ray(0.8, 0.1, {0.0, 0.0});
    double farthest = 0.0;
    for (const glm::dvec2 lens : {glm::dvec2(1, 0), {1, 0.3}, {0.5, 0.6}, {0.2, 0.9}}) {
      const Ray ray = camera.ray(0.8, 0.1, lens);
      EXPECT_NEAR(glm::length(at_depth(ray, -4.0) - at_depth(middle, -4.0)), 0.0, 3e-6);
      EXPECT_NEAR(ray.origin.z, 3.0, 1e-6);
      farthest = std::max(farthest, double(glm::length(ray.origin - middle.origin)));
    }
    EXPECT_NEAR(farthest, 0.25, 1e-6);
  }
  EXPECT_EQ(through({{}, 0.1, {}}).focus(), 4.0) << "the target's distance";
}

/// Regression test: the SLP vectoriser of GCC 12 dropped the rounding of the origin to float (see
/// host/CMakeLists.txt).
TEST(Lens, RaysGoFromTheirRoundedOriginToWhereItIsInFocus) {
  const double aperture = 0.37, focus = 7.0;
  const Camera camera = through({Projection::kPerspective, aperture, focus});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit;
  for (int i = 0; i < 1000; ++i) {
    const double x = unit(random), y = unit(random);
    const glm::dvec2 lens(unit(random), 0.0);
    const glm::dvec3 eye(1, 2, 3), way(2.0 * (2.0 * x - 1.0), 1.0 - 2.0 * y, -1.0);
    // volatile: the stored value is rounded to float, whatever the compiler does.
    const volatile float start = static_cast<float>(eye.x + aperture * std::sqrt(lens.x));
    const glm::dvec3 origin(start, eye.y, eye.z);
    const Ray ray = camera.ray(x, y, lens);
    EXPECT_EQ(ray.origin, glm::vec3(origin));
    EXPECT_EQ(ray.direction, scaled_direction(eye + focus * way - origin));
  }
}

}  // namespace
}  // namespace raygate
