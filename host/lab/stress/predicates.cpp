// Cost of an exact decision: processor time in nanoseconds per ray and triangle, by method and
// suite; and the cost of making calls independent of the thread's floating-point state. double and
// __float128 are not exact. Compare only columns of the same run.
#include <gmpxx.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "host/exact/exact.h"
#include "host/exact/ieee_floats.h"
#include "host/lab/commands.h"
#include "host/lab/stress/oracle.h"
#include "host/lab/stress/suites.h"
#include "host/lab/timing.h"

namespace raygate::lab {
namespace {

constexpr int kRepeats = 7;

/// Some shots of a suite, all of whose tests a benchmark repeats.
struct Cases {
  std::vector<Shot> shots;
  std::size_t tests = 0;

  Cases(const Suite& suite, std::size_t count) {
    Random random(1);
    const Generator generate = suite.make();
    while (tests < count) tests += shots.emplace_back(generate(random)).tests();
  }

  /// Returns the number of tests for which `hits` returns true.
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

/// Decides by definition in any arithmetic, without the tie-break.
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
  const char* key;
  std::size_t (*hits)(const Cases& cases);  // returns the number of hits
};

template <bool (*hits)(const glm::vec3&, const glm::vec3&, const Corners&)>
std::size_t count_with(const Cases& cases) {
  return cases.count(hits);
}

bool ours(const glm::vec3& origin, const glm::vec3& direction, const Corners& t) {
  return hits_triangle({origin, direction}, t);
}

std::size_t count_with_oracle(const Cases& cases) {
  std::size_t sum = 0;
  for (const Shot& shot : cases.shots) {
    for (const Verdict& verdict : find_truth(shot).verdicts) sum += verdict.hit;
  }
  return sum;
}

/// Whether every decision is the oracle's.
bool are_right(const Cases& cases) {
  for (const Shot& shot : cases.shots) {
    const Truth truth = find_truth(shot);
    auto verdict = truth.verdicts.begin();
    for (const glm::vec3& direction : shot.directions) {
      for (const Corners& t : shot.mesh->triangles) {
        if (ours(shot.origin, direction, t) != (verdict++)->hit) return false;
      }
    }
  }
  return true;
}

/// What a call takes, in nanoseconds: the median of some repeats of ten milliseconds or more each.
template <class Call>
double time_of(const Call& call) {
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    double seconds = 0.0;
    std::size_t rounds = 0;
    while (seconds < 0.01) {
      call();
      ++rounds;
      seconds = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
    }
    times.push_back(1e9 * seconds / static_cast<double>(rounds));
  }
  return median(times);
}

double guard_time() {
  constexpr int kGuards = 1000;
  return time_of([] {
           for (int i = 0; i < kGuards; ++i) const IeeeFloats guard;
         }) /
         kGuards;
}

Row row_of(const Suite& suite) {
  // Rationals are slow, so there are few cases, with many repeats.
  const Cases cases(suite, 2000);
  const Method methods[] = {{"double_ns", count_with<plain<double>>},
                            {"raygate_ns", count_with<ours>},
                            {"float128_ns", count_with<plain<__float128>>},
                            {"rationals_ns", count_with<plain<mpq_class>>},
                            {"oracle_ns", count_with_oracle}};
  Row row = {{"table", "predicates"}, {"suite", suite.name}};
  for (const Method& method : methods) {
    const double time = time_of([&] {
      if (method.hits(cases) > cases.tests) throw std::logic_error("more hits than tests");
    });
    row[method.key] = time / static_cast<double>(cases.tests);
  }
  row["raygate"] = are_right(cases) ? "right" : "WRONG";
  return row;
}

}  // namespace

void add_predicates(CLI::App& lab, Outcome& outcome) {
  auto* app = lab.add_subcommand("predicates",
                                 "what an exact decision costs, beside rationals and __float128");
  app->callback([&outcome] {
    for (const Suite& suite : all_suites()) {
      if (suite.name == "useless") continue;  // cannot be computed in rationals
      outcome.results.add(row_of(suite));
      if (outcome.results.rows().back()["raygate"] != "right") outcome.status = 1;
    }
    outcome.results.add({{"table", "guard"}, {"ns", guard_time()}});
  });
}

}  // namespace raygate::lab
