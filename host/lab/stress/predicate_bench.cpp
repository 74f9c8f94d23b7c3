// What an exact decision costs: nanoseconds for each ray and triangle, by method and kind of case.
// Nothing passes or fails; compare the columns of one run.
#include <gmpxx.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>

#include "host/exact/exact.h"
#include "host/lab/stress/oracle.h"
#include "host/lab/stress/suites.h"

namespace raygate::stress {
namespace {

constexpr int kRepeats = 7;

/// Some shots of a suite; a benchmark goes through all their tests, again and again.
struct Cases {
  const Suite* suite;
  std::vector<Shot> shots;
  std::size_t tests = 0;

  Cases(const Suite& of, std::size_t count) : suite(&of) {
    Random random(1);
    const Generator generate = of.make();
    while (tests < count) tests += shots.emplace_back(generate(random)).tests();
  }

  /// How many of the tests `hits` says are hits.
  template <class Hits>
  std::size_t count(const Hits& hits) const {
    std::size_t sum = 0;
    for (const Shot& shot : shots) {
      for (const glm::vec3& direction : shot.directions) {
        for (const Corners& t : shot.mesh->triangles) sum += hits(shot.origin, direction, t);
      }
    }
    return sum;
  }
};

double processor_nanoseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

/// The median of some repeats of ten milliseconds or more each, in nanoseconds a test.
double time_of(const Cases& cases, const std::function<std::size_t()>& run, std::size_t& hits) {
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const double start = processor_nanoseconds();
    int rounds = 0;
    do {
      hits = run();
      ++rounds;
    } while (processor_nanoseconds() - start < 1e7);
    times.push_back((processor_nanoseconds() - start) /
                    (rounds * static_cast<double>(cases.tests)));
  }
  std::ranges::nth_element(times, times.begin() + kRepeats / 2);
  return times[kRepeats / 2];
}

/// The definition in any arithmetic, without the tie-break.
template <class Number>
bool plain(const glm::vec3& origin, const glm::vec3& direction, const Corners& t) {
  using Vector = std::array<Number, 3>;
  const auto minus = [](const glm::vec3& a, const glm::vec3& b) {
    return Vector{Number(a.x) - Number(b.x), Number(a.y) - Number(b.y), Number(a.z) - Number(b.z)};
  };
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const auto side = [](const Vector& a, const Vector& b) {
    const Number sum = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    return sum > 0 ? 1 : (sum < 0 ? -1 : 0);
  };
  const Vector i = minus(direction, glm::vec3(0.0f));
  const Vector v[3] = {minus(t[0], origin), minus(t[1], origin), minus(t[2], origin)};
  const int plane = side(v[0], cross(v[1], v[2]));
  for (int k = 0; k < 3; ++k) {
    if (side(i, cross(v[k], v[(k + 1) % 3])) != plane) return false;
  }
  return plane != 0;
}

struct Method {
  const char* name;
  bool (*hits)(const glm::vec3& origin, const glm::vec3& direction, const Corners& t);
};

void print_row(const Suite& suite) {
  // Rationals are slow: few cases, each often.
  const Cases cases(suite, 2000);
  std::printf("| %-18s |", suite.name.c_str());
  const Method methods[] = {{"double", plain<double>},
                            {"ours",
                             [](const glm::vec3& o, const glm::vec3& d, const Corners& t) {
                               return hits_triangle({o, d}, t);
                             }},
                            {"float128", plain<__float128>},
                            {"rationals", plain<mpq_class>}};
  std::size_t expected = 0, hits = 0;
  for (const Method& method : methods) {
    const double time = time_of(
        cases, [&] { return cases.count(method.hits); }, hits);
    if (method.hits == methods[1].hits) expected = hits;
    std::printf(" %9.1f |", time);
  }
  const double oracle = time_of(
      cases,
      [&] {
        std::size_t sum = 0;
        for (const Shot& shot : cases.shots) {
          for (const Verdict& verdict : find_truth(shot).verdicts) sum += verdict.hit;
        }
        return sum;
      },
      hits);
  std::printf(" %9.1f |%s\n", oracle, hits == expected ? "" : " and ours is wrong");
}

}  // namespace
}  // namespace raygate::stress

int main() {
  using namespace raygate::stress;
  std::printf(
      "Nanoseconds of a processor for each ray and triangle (median of %d). Ours: double with an\n"
      "error bound, and expansions where that is not enough. double and __float128 are not exact;\n"
      "rationals are GMP's; the stress test's oracle also finds t and the nearest.\n\n",
      kRepeats);
  std::printf(
      "| suite              |    double |      ours | __float128 | rationals |    oracle |\n"
      "|---|---:|---:|---:|---:|---:|\n");
  for (const Suite& suite : all_suites()) {
    if (suite.name != "useless") print_row(suite);
  }
}
