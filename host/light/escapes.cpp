#include "host/light/escapes.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "host/base/vectors.h"

namespace raygate {

void add_environment(const ShadingScene& shading, const HitBlock& block,
                     std::span<const std::uint32_t> at, bool is_asked, WaveOutput& output) {
  const Environment& environment = *shading.lights.environment();
  const std::uint32_t source = shading.lights.environment_source();
  in_vectors([&](auto code) RAYGATE_BODY {
    using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
    constexpr std::size_t kCount = LanesOf<T>::kCount;
    enum : std::uint8_t { kDirection, kWeight = 3, kDensity = 6, kChance, kFields };
    for (std::size_t i = 0; i < at.size(); i += kCount) {
      const std::size_t count = std::min(kCount, at.size() - i);
      Gathered<T, kFields> in;
      for (std::size_t k = 0; k < kCount; ++k) {
        const std::uint32_t place = at[i + std::min(k, count - 1)];
        const Burden& burden = block.burden(place);
        const int lane = static_cast<int>(k);
        in.put(kDirection, lane, block.wave->rays[block.begin + place].direction);
        in.put(kWeight, lane, burden.weight);
        in.values[kDensity][k] = burden.density;
        in.values[kChance][k] =
            is_asked && burden.density > 0.0f
                ? shading.lights.chance<T>(source, burden.scattered_at, burden.normal)
                : 0.0f;
      }
      const Triple<T> direction = normalized(in.triple(kDirection));
      Triple<T> light = in.triple(kWeight) * environment.radiance(direction);
      if (is_asked) {
        const T density = in.one(kDensity);
        const T asked = environment.density(direction) * in.one(kChance);
        light = light * choose(density > 0.0f, share_of(density, asked), spread<T>(1.0f));
      }
      const Gathered<T, 3> lights = Hits<T>::spread_out(light);
      for (std::size_t k = 0; k < count; ++k) {
        output.radiance[block.burden(at[i + k]).sample] +=
            Hits<T>::triple_of(lights, static_cast<int>(k));
      }
    }
  });
}

}  // namespace raygate
