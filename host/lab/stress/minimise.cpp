#include "host/lab/stress/minimise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "host/exact/exact.h"
#include "host/lab/stress/tally.h"
#include "host/scene/camera.h"

namespace raygate::lab {
namespace {

int word_complexity(float x) {
  if (x == 0.0f) return 0;
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const int exponent = static_cast<int>(bits >> 23 & 0xFF) - 127;
  return 2 + 2 * std::popcount(bits & 0x7FFFFF) + std::abs(exponent) + static_cast<int>(bits >> 31);
}

/// Visits every vector of a case: origin, direction, vertices.
template <class AnyCase, class Visit>
void for_each_vector(AnyCase& failure, Visit visit) {
  visit(failure.origin);
  visit(failure.direction);
  for (auto& triangle : failure.triangles) {
    for (auto& vertex : triangle) visit(vertex);
  }
}

std::vector<float*> words(Case& failure) {
  std::vector<float*> result;
  for_each_vector(failure, [&](glm::vec3& v) {
    for (int k = 0; k < 3; ++k) result.push_back(&v[k]);
  });
  return result;
}

/// Returns x rounded to at most this number of digits.
float rounded(float x, int digits) {
  int exponent;
  const float fraction = std::frexp(x, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(fraction, digits)), exponent - digits);
}

/// Returns whether a case is valid: usable directions must stay usable, and scaled.
bool admissible(const Case& failure, bool useful) {
  bool fine = true;
  const auto finite = [](const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  for (const Corners& triangle : failure.triangles) {
    for (const glm::vec3& vertex : triangle) fine = fine && finite(vertex);
  }
  if (!fine || !finite(failure.origin)) return false;
  if (is_usable(failure.direction) != useful) return false;
  if (!useful) return true;
  const glm::vec3 size = glm::abs(failure.direction);
  const float largest = std::max({size.x, size.y, size.z});
  return largest >= 1.0f && largest < 2.0f;
}

class Minimiser {
 public:
  Minimiser(Case failure, const std::function<bool(const Case&)>& fails)
      : best_(std::move(failure)), useful_(is_usable(best_.direction)), fails_(fails) {}

  Case run() {
    for (int before = complexity(best_) + 1; complexity(best_) < before;) {
      before = complexity(best_);
      leave_out_triangles();
      move_to_origin();
      scale();
      simplify_words();
    }
    return best_;
  }

 private:
  /// Accepts the candidate if it is simpler and fails.
  bool offer(const Case& candidate) {
    if (complexity(candidate) >= complexity(best_) || !admissible(candidate, useful_) ||
        !fails_(candidate))
      return false;
    best_ = candidate;
    return true;
  }

  /// Also tries rays aimed at simple points of edges: if a failure depends on a ray through an
  /// edge, no other value can be changed alone.
  bool offer_aimed(const Case& candidate) {
    if (offer(candidate)) return true;
    for (const Corners& triangle : candidate.triangles) {
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 a(triangle[k]), b(triangle[(k + 1) % 3]);
        for (const double along : {0.0, 0.5, 0.25, 0.75, 0.125, 0.375, 1.0 / 3.0, 2.0 / 3.0}) {
          const glm::dvec3 way = glm::mix(a, b, along) - glm::dvec3(candidate.origin);
          if (way == glm::dvec3(0.0)) continue;
          Case aimed = candidate;
          aimed.direction = scaled_direction(way);
          if (offer(aimed)) return true;
        }
      }
    }
    return false;
  }

  void leave_out_triangles() {
    for (std::size_t i = best_.triangles.size(); i-- > 0 && best_.triangles.size() > 1;) {
      Case candidate = best_;
      candidate.triangles.erase(candidate.triangles.begin() + static_cast<std::ptrdiff_t>(i));
      offer(candidate);
    }
  }

  void move_to_origin() {
    Case candidate = best_;
    for (Corners& triangle : candidate.triangles) {
      for (glm::vec3& vertex : triangle) vertex -= candidate.origin;
    }
    candidate.origin = glm::vec3(0.0f);
    offer(candidate);
  }

  void scale() {
    for (const int exponent : {-64, 64, -16, 16, -4, 4, -1, 1}) {
      for (bool better = true; better;) {
        Case candidate = best_;
        const float factor = std::ldexp(1.0f, exponent);
        candidate.origin *= factor;
        for (Corners& triangle : candidate.triangles) {
          for (glm::vec3& vertex : triangle) vertex *= factor;
        }
        better = offer(candidate);
      }
    }
  }

  void simplify_words() {
    const std::size_t count = words(best_).size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto with = [&](float value) {
        Case candidate = best_;
        *words(candidate)[i] = value;
        return candidate;
      };
      const float old = *words(best_)[i];
      if (!std::isfinite(old) || old == 0.0f) continue;
      std::vector<float> simpler = {0.0f, 1.0f, -1.0f};
      for (std::size_t k = i % 3; k < count; k += 3) simpler.push_back(*words(best_)[k]);
      for (int digits = 1; digits < 24; ++digits) {
        const float near = rounded(old, digits), step = std::ldexp(1.0f, std::ilogb(old) - digits);
        simpler.insert(simpler.end(), {near, near + step, near - step});
      }
      simpler.push_back(-old);
      std::ranges::sort(simpler, {}, [](float x) { return std::pair(word_complexity(x), x); });
      for (const float value : simpler) {
        if (offer_aimed(with(value))) break;
      }
    }
  }

  Case best_;
  bool useful_;
  const std::function<bool(const Case&)>& fails_;
};

}  // namespace

int complexity(const Case& failure) {
  int sum = 1000 * static_cast<int>(failure.triangles.size());
  for_each_vector(failure, [&](const glm::vec3& v) {
    for (int k = 0; k < 3; ++k) sum += word_complexity(v[k]);
  });
  return sum;
}

Case minimise(Case failure, const std::function<bool(const Case&)>& fails) {
  return Minimiser(std::move(failure), fails).run();
}

bool decides_wrongly(const SubjectKind& kind, Subject& subject, const Case& failure) {
  const Shot shot = shot_of(failure);
  const Truth truth = find_truth(shot);
  Answers answers;
  subject.run({&shot, 1}, answers);
  Tally tally;
  count({&shot, 1}, {&truth, 1}, answers, kind, tally);
  return tally.wrong_decisions(kind.exact) != 0;
}

}  // namespace raygate::lab
