#include "host/intersect/point_writer.h"

namespace raygate {

void PointWriter::write() {
  for (std::size_t first = 0; first < planes_; first += kPlanes) {
    PlaneViews views;
    for (std::size_t i = 0; i < kPlanes; ++i) {
      const std::size_t plane = std::min(first + i, planes_ - 1);
      views.origins[i] = rays_[firsts_[plane]].origin;
      views.triangles[i] = bvh_.corners_of(primitives_[plane]);
    }
    Planes four;
    make_planes(views, four);
    for (int k = 0; k < 4; ++k) std::memcpy(&words_[k][first], four.words[k], sizeof four.words[k]);
  }
  in_vectors([&](auto) RAYGATE_BODY {
    for (std::size_t first = 0; first < count_; first += kQuad) {
      FloatQuad rows[kQuad], n[kQuad], point[3];  // n[3]: d of the plane
      std::uint32_t number[kQuad];
      for (std::size_t i = 0; i < kQuad; ++i) {
        const std::size_t at = std::min(first + i, count_ - 1);
        number[i] = numbers_[at];
        rows[i] = load<FloatQuad>(reinterpret_cast<const float*>(&rays_[number[i]] + 1) - kQuad);
        for (int k = 0; k < 4; ++k) n[k][static_cast<int>(i)] = words_[k][plane_of_[at]];
      }
      transpose(rows);  // rows[0] is unused: the last coordinate of the origins
      IntQuad largest = {}, error;
      for (int k = 0; k < 3; ++k) largest = maximum(largest, bits_in(n[k]) >> 23 & 0xFF);
      plane_points({n[0], n[1], n[2]}, n[3], largest, {rows[1], rows[2], rows[3]}, point, error);
      std::copy_n(point, 3, rows);
      rows[3] = float_of(error);
      transpose(rows);
      static_assert(offsetof(NearestHit, point_error) ==
                    offsetof(NearestHit, point) + 3 * sizeof(float));
      for (std::size_t i = 0; i < kQuad; ++i) std::memcpy(&hits_[number[i]].point, &rows[i], 16);
    }
  });
  written_ += count_;
  planes_ = count_ = 0;
}

}  // namespace raygate
