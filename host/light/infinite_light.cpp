#include "host/light/infinite_light.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "host/base/vectors.h"

namespace raygate {

void add_infinite_light(const ShadingScene& shading, const HitBlock& block,
                        std::span<const std::uint32_t> at, bool is_asked, ShadingOutput& output) {
  const Environment& environment = *shading.lights.environment();
  const std::uint32_t source = shading.lights.environment_source();
  in_vectors([&](auto code) RAYGATE_BODY {
    using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
    constexpr std::size_t kCount = LanesOf<T>::kCount;
    enum : std::uint8_t { kDirection, kThroughput = 3, kPdf = 6, kChance, kFields };
    for (std::size_t i = 0; i < at.size(); i += kCount) {
      const std::size_t count = std::min(kCount, at.size() - i);
      Gathered<T, kFields> in;
      for (std::size_t k = 0; k < kCount; ++k) {
        const std::uint32_t place = at[i + std::min(k, count - 1)];
        const PathState& state = block.state(place);
        const int lane = static_cast<int>(k);
        in.put(kDirection, lane, block.batch->rays[block.begin + place].direction);
        in.put(kThroughput, lane, state.throughput);
        in.values[kPdf][k] = state.pdf;
        in.values[kChance][k] =
            is_asked && state.pdf > 0.0f
                ? shading.lights.pmf<T>(source, state.scattered_at, state.normal)
                : 0.0f;
      }
      const Triple<T> direction = normalized(in.triple(kDirection));
      Triple<T> light = in.triple(kThroughput) * environment.radiance(direction);
      if (is_asked) {
        const T pdf = in.one(kPdf);
        const T asked = environment.pdf(direction) * in.one(kChance);
        light = light * choose(pdf > 0.0f, power_heuristic(pdf, asked), spread<T>(1.0f));
      }
      const Gathered<T, 3> lights = Hits<T>::spread_out(light);
      for (std::size_t k = 0; k < count; ++k) {
        output.radiance[block.state(at[i + k]).sample] +=
            Hits<T>::triple_of(lights, static_cast<int>(k));
      }
    }
  });
}

}  // namespace raygate
