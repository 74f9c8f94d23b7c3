#include "host/light/light_paths.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "host/base/elementary.h"
#include "host/scene/bounds.h"
#include "host/scene/instances.h"

namespace raygate {
namespace {

constexpr double kPi = std::numbers::pi;

// Pixels per light path. Few paths suffice, because they are aimed at mirrors and glass. The number
// is a compromise between caustics that camera paths find, too, and other caustics.
constexpr std::uint64_t kPixelsOfPath = 8;

std::uint64_t pixels_of(const FrameView& frame) {
  return static_cast<std::uint64_t>(frame.width) * static_cast<std::uint64_t>(frame.height);
}

// Streams of random numbers for starts; surfaces use other streams.
constexpr std::uint32_t kLightPaths = 0x6C696768;
constexpr std::uint32_t kSource = 10, kPlace = 11, kBall = 12, kTowards = 13;

glm::dvec3 wide(const Triple<float>& v) { return {v.x, v.y, v.z}; }
Triple<float> narrow(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Returns the unit vector at the angle with this cosine and sine to the unit vector `axis`;
/// `turns` is the azimuth in turns. With cosine 0, `sine` can be any length of the result.
glm::dvec3 around(const glm::dvec3& axis, double cosine, double sine, double turns) {
  const Frame<float> frame(narrow(axis));
  const SineCosine<double> turn = sine_cosine(turns);
  return cosine * axis + sine * (turn.cosine * wide(frame.u) + turn.sine * wide(frame.v));
}

}  // namespace

double LightPaths::Ball::solid_angle(const glm::dvec3& point) const {
  const glm::dvec3 way = middle - point;
  const double squared = glm::dot(way, way);
  if (squared <= radius * radius) return 4.0 * kPi;
  const double sine_squared = radius * radius / squared;
  return 2.0 * kPi * sine_squared / (1.0 + std::sqrt(1.0 - sine_squared));
}

bool LightPaths::Ball::meets(const glm::dvec3& point, const glm::dvec3& direction,
                             bool both_ways) const {
  const glm::dvec3 way = middle - point;
  const double along = glm::dot(way, direction);
  const double squared = glm::dot(way, way), most = radius * radius;
  return squared <= most || ((both_ways || along > 0.0) && squared - along * along <= most);
}

LightPaths::LightPaths(const PreparedScene& prepared, const Lights& lights, const FrameView& frame)
    : lights_(lights),
      count_((pixels_of(frame) + kPixelsOfPath - 1) / kPixelsOfPath),
      frame_(frame),
      area_per_pixel_(
          finite_float(frame.camera.picture_area() / static_cast<double>(pixels_of(frame)))) {
  if (!lights.any_power() ||
      std::ranges::none_of(prepared.materials, &MaterialParameters::is_mirror_or_glass))
    return;
  find_balls(prepared);
  if (balls_.empty()) return;
  reach_ = 4.0 * glm::length(position_bounds(prepared.scene).half_size());
  weigh_sources();
}

void LightPaths::find_balls(const PreparedScene& prepared) {
  constexpr std::size_t kMostBalls = 16;  // beyond this, one sphere holds all mirrors and glass
  const auto visit = [&](const auto& each) {
    for (std::uint32_t primitive = 0; primitive < prepared.bvh.primitive_count(); ++primitive) {
      const FaceRef face = prepared.bvh.face_of(primitive);
      if (!prepared.materials[face_at(prepared.scene, face).material].is_mirror_or_glass())
        continue;
      for (const glm::dvec3& corner : prepared.bvh.corners_of(primitive)) {
        each(object_at(prepared.scene, face), corner);
      }
    }
  };
  std::map<std::uint32_t, Bounds3> boxes;
  visit([&](std::uint32_t object, const glm::dvec3& corner) { boxes[object].expand(corner); });
  const bool are_many = boxes.size() > kMostBalls;
  Bounds3 all;
  for (const auto& [object, box] : boxes) {
    all.expand(box.low);
    all.expand(box.high);
  }
  std::map<std::uint32_t, Ball> balls;  // by object, or one for all
  visit([&](std::uint32_t object, const glm::dvec3& corner) {
    const auto [at, is_new] = balls.try_emplace(are_many ? 0 : object);
    Ball& ball = at->second;
    if (is_new) ball.middle = are_many ? all.middle() : boxes[object].middle();
    ball.radius = std::max(ball.radius, glm::distance(ball.middle, corner));
  });
  constexpr double kRounding = 1.0 + 0x1p-20;
  for (auto& [object, ball] : balls) {
    ball.radius *= kRounding;
    const double radius = ball.radius * lights_.per_unit();
    discs_ += kPi * radius * radius;
    balls_.push_back(ball);
  }
}

/// Sets the sources' probabilities by the flux that each sends to the spheres from its centre.
void LightPaths::weigh_sources() {
  double sum = 0.0;
  for (std::uint32_t i = 0; i < lights_.source_count(); ++i) {
    const Lights::Source& source = lights_.source(i);
    const Lights::Light& light = lights_.light(source.light);
    double flux = mean(glm::dvec3(light.emission));
    if (light.kind == Lights::Kind::kPoint) {
      flux *= solid_angle(glm::dvec3(light.position));
    } else if (light.kind == Lights::Kind::kArea) {
      const auto middle = lights_.sample_patches<float>({source.patch}, {0.5f, 0.5f});
      flux *= solid_angle(wide(middle.position)) / double{source.per_area};
    } else if (light.kind == Lights::Kind::kDirection) {
      flux *= discs_;
    } else {
      flux = 4.0 * kPi * mean(lights_.environment()->mean_radiance()) * discs_;
    }
    if (flux > 0.0 && std::isfinite(flux)) sum += flux;
    source_cdf_.push_back(sum);
  }
  if (!(sum > 0.0)) source_cdf_.clear();
  for (double& value : source_cdf_) value /= sum;
}

double LightPaths::solid_angle(const glm::dvec3& point) const {
  double sum = 0.0;
  for (const Ball& ball : balls_) sum += ball.solid_angle(point);
  return sum;
}

/// Returns the number of spheres that a ray, or with `both_ways` a line, meets.
double LightPaths::meetings(const glm::dvec3& point, const glm::dvec3& direction,
                            bool both_ways) const {
  double count = 0.0;
  for (const Ball& ball : balls_) count += ball.meets(point, direction, both_ways) ? 1.0 : 0.0;
  return count;
}

float LightPaths::density(std::uint32_t source, const glm::vec3& point,
                          const glm::vec3& direction) const {
  const glm::dvec3 from(point);
  const double per_area = lights_.source(source).per_area;
  return finite_float(static_cast<double>(count()) * pmf(source) * per_area *
                      meetings(from, glm::dvec3(direction), false) / solid_angle(from));
}

float LightPaths::environment_density(const glm::vec3& point, const glm::vec3& towards) const {
  const float pdf =
      lights_.environment()->pdf<float>(Triple<float>{towards.x, towards.y, towards.z});
  return finite_float(static_cast<double>(count()) * pmf(lights_.environment_source()) *
                      double{pdf} * meetings(glm::dvec3(point), glm::dvec3(towards), true) /
                      discs_);
}

/// Chooses a sphere for u in [0, 1) with a probability proportional to size(sphere).
template <class Size>
const LightPaths::Ball& LightPaths::choose_ball(double u, const Size& size) const {
  double left = 0.0;
  for (const Ball& ball : balls_) left += size(ball);
  left *= u;
  for (const Ball& ball : balls_) {
    if (left < size(ball)) return ball;
    left -= size(ball);
  }
  return balls_.back();
}

/// Samples a direction from `point`, uniformly in the solid angles of all spheres.
glm::dvec3 LightPaths::direction_from(const glm::dvec3& point, double choice,
                                      const SquarePoint<float>& u) const {
  const Ball& ball = choose_ball(choice, [&](const Ball& each) { return each.solid_angle(point); });
  const double height = ball.solid_angle(point) / (2.0 * kPi);  // of the cap of the unit sphere
  const double cosine = 1.0 - double{u.x} * height;
  const glm::dvec3 axis = height < 2.0 ? glm::normalize(ball.middle - point) : glm::dvec3(0, 0, 1);
  return around(axis, cosine, std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), u.y);
}

std::optional<LightPaths::Start> LightPaths::start(std::uint64_t number, std::uint64_t seed) const {
  Start start;
  PathState& state = start.state;
  state.index = static_cast<std::uint32_t>(number);
  state.stream = pixel_key(seed, kLightPaths, static_cast<std::uint32_t>(number >> 32));
  const auto random = [&](std::uint32_t purpose) {
    return random_point<float>(state.index, state.stream, purpose);
  };
  const SquarePoint<float> choice = random(kSource), u = random(kTowards);
  const double ball_choice = random(kBall).x;
  const double wanted = double{choice.x} + double{choice.y} * 0x1p-24;
  const auto found = std::upper_bound(source_cdf_.begin(), source_cdf_.end() - 1, wanted);
  const auto source = static_cast<std::uint32_t>(found - source_cdf_.begin());
  const Lights::Light* const light = &lights_.light(lights_.source(source).light);
  glm::dvec3 origin, direction, flux(light->emission);
  double density = static_cast<double>(count()) * pmf(source);
  if (light->kind == Lights::Kind::kPoint) {
    origin = glm::dvec3(light->position);
    direction = direction_from(origin, ball_choice, u);
    density *= meetings(origin, direction, false) / solid_angle(origin);
    if (light->is_spot) {
      const auto cosine = static_cast<float>(glm::dot(direction, glm::dvec3(light->spot_axis)));
      flux *= double{spot_falloff(cosine, light->spot_scale, light->spot_offset)};
    }
  } else if (light->kind == Lights::Kind::kArea) {
    const Lights::Source& own = lights_.source(source);
    const LightPoint<float> point = lights_.sample_patches<float>({own.patch}, random(kPlace));
    origin = wide(point.position);
    direction = direction_from(origin, ball_choice, u);
    density *= double{own.per_area} * meetings(origin, direction, false) / solid_angle(origin);
    const double cosine = std::abs(glm::dot(direction, wide(point.normal)));
    flux = wide(lights_.radiance_at<float>({light}, point)) * cosine;
    state.light_over_camera_pdf = finite_float(cosine / density);
    double nearest = reach_;
    for (const Ball& ball : balls_) nearest = std::min(nearest, glm::distance(ball.middle, origin));
    origin += direction * (0x1p-16 * nearest);  // off the light's surface
  } else {
    glm::dvec3 towards(light->position);
    if (light->kind == Lights::Kind::kEnvironment) {
      const Triple<float> sampled = lights_.environment()->sample<float>(random(kPlace));
      towards = wide(sampled);
      flux = wide(lights_.environment()->radiance<float>(sampled));
      density *= double{lights_.environment()->pdf<float>(sampled)};
    }
    const Ball& ball =
        choose_ball(ball_choice, [](const Ball& each) { return each.radius * each.radius; });
    const glm::dvec3 across =
        ball.middle + around(towards, 0.0, ball.radius * std::sqrt(double{u.x}), u.y);
    density *= meetings(across, towards, true) / discs_;
    if (light->kind == Lights::Kind::kEnvironment)
      state.light_over_camera_pdf = finite_float(1.0 / density);
    origin = across + towards * reach_;
    direction = -towards;
  }
  flux /= density;
  if (!(mean(flux) > 0.0) || !std::isfinite(mean(flux))) return std::nullopt;
  state.throughput = finite_floats(flux);
  start.ray = {glm::vec3(origin), scaled_direction(direction)};
  return start;
}

LightPaths::View LightPaths::view_of(const glm::vec3& point, const glm::vec2& lens) const {
  const Camera& camera = frame_.camera;
  const glm::dvec3 eye = camera.lens_point(glm::dvec2(lens));
  View view{.lens = glm::vec3(eye)};
  const auto place = camera.place_of(glm::dvec3(point), eye);
  if (!place || place->x < frame_.low.x || place->x > frame_.high.x || place->y < frame_.low.y ||
      place->y > frame_.high.y) {
    return view;
  }
  const glm::dvec3 way = (glm::dvec3(point) - eye) * double{lights_.per_unit()};
  const double far = glm::dot(way, camera.forward()), distance = glm::length(way);
  // Pixels per area perpendicular to the axis at distance 1, over cosine^3 and squared distance.
  view.per_area = finite_float(static_cast<double>(pixels_of(frame_)) / camera.picture_area() *
                               distance / (far * far * far));
  return view;
}

}  // namespace raygate
