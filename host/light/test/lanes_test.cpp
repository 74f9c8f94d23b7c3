// Functions give the same bits with several lanes as with one lane, also for special numbers.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "host/base/elementary.h"
#include "host/base/test/using_vectors.h"
#include "host/base/triple.h"
#include "host/light/sampler.h"
#include "host/light/scattering.h"

namespace raygate {
namespace {

constexpr int kInputs = 6, kOutputs = 4, kRounds = 20000;

/// Inputs of kLanes calls of a function with up to kInputs arguments, and their outputs.
struct Case {
  alignas(64) float in[kInputs][kLanes];
  alignas(64) float out[kOutputs][kLanes];
};

/// Generates numbers of every size, in [-1, 1] and [0, 1], zeros, subnormals, infinities and NaN.
class Inputs {
 public:
  void fill(Case& c) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kOdd[] = {
        0.0f,  -0.0f,  1.0f,      -1.0f,      0x1p-149f, 0x1p-126f,
        1e30f, -1e30f, kInfinity, -kInfinity, 0.5f,      std::numeric_limits<float>::quiet_NaN()};
    for (auto& input : c.in) {
      for (float& x : input) {
        const std::uint32_t choice = engine_() % 8;
        x = choice == 0   ? kOdd[engine_() % std::size(kOdd)]
            : choice == 1 ? std::bit_cast<float>(static_cast<std::uint32_t>(engine_()))
            : choice < 5  ? std::uniform_real_distribution<float>(-1.0f, 1.0f)(engine_)
                          : std::uniform_real_distribution<float>(0.0f, 1.0f)(engine_);
      }
    }
  }

 private:
  std::mt19937 engine_{3};
};

/// Compares f(in, out) over all lanes at once with f lane by lane, for each instruction set of this
/// machine. The bits must be equal, except those of NaNs.
template <class Function>
void compare(const Function& f) {
  for (const Vectors vectors : machine_vectors()) {
    const UsingVectors in_use(vectors);
    Inputs inputs;
    for (int round = 0; round < kRounds; ++round) {
      Case c{}, expected{};
      inputs.fill(c);
      expected = c;
      in_vectors([&](auto) RAYGATE_BODY {
        FloatLanes in[kInputs], out[kOutputs] = {};
        for (int i = 0; i < kInputs; ++i) in[i] = load<FloatLanes>(c.in[i]);
        f(in, out);
        for (int i = 0; i < kOutputs; ++i) store(c.out[i], out[i]);
      });
      for (int k = 0; k < kLanes; ++k) {
        float in[kInputs], out[kOutputs] = {};
        for (int i = 0; i < kInputs; ++i) in[i] = c.in[i][k];
        f(in, out);
        for (int i = 0; i < kOutputs; ++i) expected.out[i][k] = out[i];
      }
      for (int i = 0; i < kOutputs; ++i) {
        for (int k = 0; k < kLanes; ++k) {
          const float a = c.out[i][k], b = expected.out[i][k];
          ASSERT_TRUE((std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0)
              << a << " instead of " << b << ", " << name_of(vectors) << ", lane " << k;
        }
      }
    }
  }
}

template <class T>
RAYGATE_INLINE Triple<T> triple(const T* in) {
  return {in[0], in[1], in[2]};
}
template <class T>
RAYGATE_INLINE void put(const Triple<T>& value, T* out) {
  out[0] = value.x;
  out[1] = value.y;
  out[2] = value.z;
}

TEST(Lanes, ArithmeticIsTheScalars) {
  compare([](auto& in, auto& out) RAYGATE_BODY {
    out[0] = root(in[0]);
    out[1] = choose(in[1] < in[2], in[3], in[4]);
    out[2] = narrow(wide(in[1]) * wide(in[2]) / root(wide(in[3])));
    out[3] = maximum(at_most(at_least(in[0], 0.25f), 0.75f), minimum(in[1], absolute(in[2])));
  });
  compare([](auto& in, auto& out) RAYGATE_BODY {
    put(normalized(triple(in)), out);
    out[3] = dot(triple(in), triple(in + 3));
  });
}

TEST(Lanes, DirectionsAreTheScalars) {
  compare([](auto& in, auto& out) RAYGATE_BODY {
    const auto turns = at_least(at_most(in[5], 1.0f), 0.0f);
    put(spherical_direction(normalized(triple(in)), in[3], in[4], turns), out);
  });
  compare([](auto& in, auto& out) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(in[0])>;
    const Triple<T> normal = normalized(triple(in)), view = normalized(triple(in + 3));
    const Refraction<T> refraction(view, normal, 1.0f + absolute(in[0]));
    put(refraction.direction, out);
    out[3] = choose(refraction.exists, in[0], in[1]);
  });
  compare([](auto& in, auto& out) RAYGATE_BODY {
    out[0] = fresnel_reflectance(in[0], in[1]);
    out[1] = schlick_weight(in[2]);
    put(reflect(triple(in), triple(in + 3)), out + 1);
  });
}

TEST(Lanes, FacetsAreTheScalars) {
  compare([](auto& in, auto& out) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(in[0])>;
    const Triple<T> view = normalized(triple(in)), light = normalized(triple(in + 3));
    const T alpha = at_most(at_least(absolute(in[1]), Ggx<T>::kLeast), 1.0f);
    const Ggx<T> ggx({T{}, T{}, spread<T>(1.0f)}, alpha);
    const auto u = at_most(at_least(in[2], 0.0f), 1.0f);
    put(ggx.sample(view, {u, u}), out);
    const auto pair = ggx.pair(view, light);
    out[3] = pair.d * ggx.visibility(view.z, light.z) + pair.cos_half;
  });
}

TEST(Lanes, ElementaryFunctionsAreTheScalars) {
  compare([](auto& in, auto& out) RAYGATE_BODY {
    const auto turns = at_most(at_least(in[0] * 100.0f, -900.0f), 900.0f);
    const auto found = sine_cosine(wide(turns));
    out[0] = narrow(found.sine);
    out[1] = narrow(found.cosine);
    const auto base = wide(at_most(at_least(in[1], 0x1p-100f), 1.0f));
    const auto exponent = wide(at_most(at_least(in[2] * 1e4f, 0.0f), 1e6f));
    out[2] = narrow(power(base, exponent));
    out[3] = narrow(binary_logarithm(base));
  });
}

TEST(Lanes, RandomNumbersAreTheScalars) {
  compare([](auto& in, auto& out) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(in[0])>;
    WordOf<T> index, key;
    std::memcpy(&index, &in[0], sizeof index);
    std::memcpy(&key, &in[1], sizeof key);
    const auto point = sobol_point<T>(index, hash(key, 5u));
    out[0] = point.x;
    out[1] = point.y;
  });
}

}  // namespace
}  // namespace raygate
