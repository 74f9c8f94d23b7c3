#include "host/light/scattering.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "host/base/vectors.h"

namespace raygate {
namespace {

/// Returns an entry of FacetAlbedo for a direction with this cosine to the normal: of of_mirrors()
/// if `index` is 0, otherwise of of_glass(index).
template <class T>
RAYGATE_INLINE FacetAlbedo::Shares<T> leaving(const T& cosine, float alpha, float index) {
  const Ggx<T> ggx({T{}, T{}, spread<T>(1.0f)}, spread<T>(alpha));
  const Triple<T> view = {root(1.0f - cosine * cosine), T{}, cosine};
  // Points of the integral, denser at steep facets, where masking begins. By symmetry, half of all
  // azimuths suffice. Glass needs more points, as total reflection begins abruptly.
  const int steps = index == 0.0f ? 16 : 32, turns = steps / 2;
  FacetAlbedo::Shares<T> sum = {T{}, T{}};
  for (int i = 0; i < steps; ++i) {
    const float left = 1.0f - (static_cast<float>(i) + 0.5f) / static_cast<float>(steps);
    const float weight = 2.0f * left / static_cast<float>(steps * turns);
    for (int k = 0; k < turns; ++k) {
      const float turn = (static_cast<float>(k) + 0.5f) / static_cast<float>(2 * turns);
      const Triple<T> facet = ggx.sample(view, {spread<T>(1.0f - left * left), spread<T>(turn)});
      const T inner = at_most(at_least(dot(view, facet), 0.0f), 1.0f);
      const T light = reflect(view, facet).z;
      const T mirrored = choose(light > 0.0f, ggx.g2_over_g1(cosine, light), T{}) * weight;
      const auto through = [&](float eta) RAYGATE_BODY {
        const T share = fresnel_reflectance(inner, spread<T>(eta));
        const T beyond = -Refraction<T>(view, facet, spread<T>(eta)).direction.z;
        const T bent = choose((share < 1.0f) & (beyond > 0.0f), ggx.g1(beyond), T{}) * weight;
        return mirrored * share + bent * (1.0f - share);
      };
      sum.first = sum.first + (index == 0.0f ? mirrored : through(index));
      sum.second =
          sum.second + (index == 0.0f ? mirrored * schlick_weight(inner) : through(1.0f / index));
    }
  }
  return sum;
}

}  // namespace

FacetAlbedo::FacetAlbedo(float index) {
  constexpr float kLeastCosine = 1e-4f;
  in_vectors([&](auto code) RAYGATE_BODY {
    using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
    constexpr int kCount = kLanesOf<T>;
    for (int row = 0; row < kSize; ++row) {
      const float rough = static_cast<float>(row) / (kSize - 1);
      for (int column = 0; column < kSize; column += kCount) {
        const T x = gather<T>(
            [&](int k) RAYGATE_BODY { return static_cast<float>(column + k) / (kSize - 1); });
        const auto shares = leaving<T>(at_least(x * x, kLeastCosine),
                                       std::max(rough * rough, Ggx<float>::kLeast), index);
        const auto first = unpack(shares.first), second = unpack(shares.second);
        for (int k = 0; k < kCount; ++k) cells_[row][column + k] = {first[k], second[k]};
      }
    }
  });
  // Means weighted by the cosine c are integrals over 2 c dc = 4 x^3 dx, with x = sqrt(c). The
  // table is linear in x between entries. Each cell has two Gauss points.
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column + 1 < kSize; ++column) {
      for (const float rest : {0.211324865f, 0.788675135f}) {
        const float x = (static_cast<float>(column) + rest) / (kSize - 1);
        const float weight = 2.0f * x * x * x / (kSize - 1);
        const Cell &a = cells_[row][column], &b = cells_[row][column + 1];
        means_[row].first += weight * between(a.first, b.first, rest);
        means_[row].second += weight * between(a.second, b.second, rest);
      }
    }
  }
}

const FacetAlbedo& FacetAlbedo::of_mirrors() {
  static const FacetAlbedo albedo(0.0f);
  return albedo;
}

const FacetAlbedo& FacetAlbedo::of_glass(float index) {
  static std::mutex mutex;
  static std::map<float, FacetAlbedo> known;
  const std::lock_guard lock(mutex);
  const auto found = known.find(index);
  return found != known.end() ? found->second
                              : known.emplace(index, FacetAlbedo(index)).first->second;
}

}  // namespace raygate
