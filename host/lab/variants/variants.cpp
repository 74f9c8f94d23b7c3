// Verilated hit-test units with a variant's parameters, and their comparison with reference models.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "host/intersect/unit/hit_tester.h"
#include "host/intersect/unit/test/same_results.h"
#include "host/lab/lab.h"
#include "host/lab/variants/variant_models.h"
#include "host/variants/variant_hit_tester.h"
#include "sim/array_model.h"
#include "sim/plane_model.h"
#include "sim/random_bursts.h"
#include "sim/rtl_units.h"

namespace raygate {
namespace {

/// Packs numbers of any format into a port of one lane, the first number in the lowest bits.
class PackedNumbers {
 public:
  explicit PackedNumbers(const Arithmetic& math) : math_(math) {}

  template <class Port>
  void write(Port& port, int, const float* x, int count) const {
    Bits bits{};
    for (int i = 0; i < count; ++i) {
      const std::uint64_t word = math_.to_word(x[i]);
      const std::size_t at = place(i) / 64, shift = place(i) % 64;
      bits[at] |= word << shift;
      if (shift != 0) bits[at + 1] |= word >> (64 - shift);
    }
    static_assert(sizeof port <= sizeof bits);
    std::memcpy(&port, bits.data(), sizeof port);
  }

  template <class Port>
  void read(const Port& port, int, float* x, int count) const {
    Bits bits{};
    std::memcpy(bits.data(), &port, sizeof port);
    for (int i = 0; i < count; ++i) {
      const std::size_t at = place(i) / 64, shift = place(i) % 64;
      const std::uint64_t above = shift != 0 ? bits[at + 1] << (64 - shift) : 0;
      const std::uint64_t mask = (std::uint64_t{1} << math_.word_bits()) - 1;
      x[i] = math_.from_word(static_cast<std::uint32_t>((bits[at] >> shift | above) & mask));
    }
  }

  [[nodiscard]] std::uint32_t to_word(float x) const { return math_.to_word(math_.read(x)); }
  [[nodiscard]] float from_word(std::uint32_t word) const { return math_.from_word(word); }

 private:
  using Bits = std::array<std::uint64_t, 9>;  // sixteen 32-bit words, and one for overflow
  [[nodiscard]] std::size_t place(int i) const {
    return static_cast<std::size_t>(i * math_.word_bits());
  }

  Arithmetic math_;
};

/// Returns whether a model with these parameters implements the variant.
bool matches(const Variant& variant, int exponent_bits, int digits, int rounding,
             int quotient_digits, std::string_view brought) {
  const Arithmetic& math = variant.math;
  return variant.has_hardware() && variant.brought == brought &&
         math.exponent_bits == exponent_bits && math.digits == digits &&
         math.rounding == static_cast<Rounding>(rounding) &&
         math.quotient_digits == quotient_digits;
}

/// Returns hit_test_pipeline, Verilated with the variant's format and rounding, or null if there is
/// none. Input floats must be numbers of the format.
std::unique_ptr<BurstUnit> make_rtl_burst_unit([[maybe_unused]] const Variant& variant) {
#define RAYGATE_MODEL(top, ...)                                                                \
  if (matches(variant, __VA_ARGS__))                                                           \
    return std::make_unique<RtlBurstUnit>(std::make_unique<ArrayModel<top, 1, PackedNumbers>>( \
        1, BurstStalls{}, PackedNumbers(variant.math)));
  RAYGATE_PIPELINE_MODELS
#undef RAYGATE_MODEL
  return nullptr;
}

/// Returns hit_test_unit, Verilated with these and QuotientBits, or null. Rounds its inputs first.
std::unique_ptr<PlaneUnit> make_rtl_plane_unit([[maybe_unused]] const Variant& variant) {
#define RAYGATE_MODEL(top, ...)            \
  if (matches(variant, __VA_ARGS__))       \
    return std::make_unique<RtlPlaneUnit>( \
        std::make_unique<PlaneModelOf<top, PackedNumbers>>(PackedNumbers(variant.math)));
  RAYGATE_SERIAL_MODELS
#undef RAYGATE_MODEL
  return nullptr;
}

/// Makes RandomBursts in a variant's format.
class VariantBursts {
 public:
  VariantBursts(const Variant& variant, std::uint64_t seed)
      : variant_(variant), math_(variant.math), bursts_(seed), random_(seed) {
    math_.rounding = Rounding::kNearestEven;  // the host's rounding
  }

  BurstBatch make(std::uint64_t tests) {
    BurstBatch batch = bursts_.make(tests);
    PolygonRecord before = batch.records.empty() ? PolygonRecord{} : narrow(batch.records.front());
    for (RayBundle& bundle : batch.bundles) {
      for (auto& component : bundle.direction) {
        for (float& x : component) x = math_.read(x);
      }
      auto* records = batch.records.data() + (bundle.records - batch.records.data());
      for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
        before = records[i] = changed(records[i], before, bundle.lane_direction(0));
      }
    }
    return batch;
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() >> 32) % n; }

  /// Returns the number of the format that is `steps` (of either sign) from `x`.
  float stepped(float x, int steps) const {
    const std::uint32_t mask = (1u << (math_.word_bits() - 1) << 1) - 1;
    return math_.from_word((math_.to_word(x) + static_cast<std::uint32_t>(steps)) & mask);
  }

  float random_number() {
    const std::uint32_t mask = (1u << (math_.word_bits() - 1) << 1) - 1;
    return math_.from_word(static_cast<std::uint32_t>(random_() >> 32) & mask);
  }

  template <class Function>
  static void for_each_word(PolygonRecord& record, Function&& function) {
    for (int k = 0; k < 3; ++k) function(record.normal[k]);
    function(record.d);
    for (glm::vec3& edge : record.edges) {
      for (int k = 0; k < 3; ++k) function(edge[k]);
    }
    for (float& bound : record.bounds) function(bound);
  }

  /// Returns the record as the host would send it (variant_record). Records that are not finite,
  /// and a quarter of the others, are rounded word by word instead.
  PolygonRecord narrow(const PolygonRecord& wide) {
    PolygonRecord record = wide;
    bool finite = true;
    for_each_word(record, [&](float& x) { finite = finite && std::isfinite(x); });
    if (finite && below(4) != 0) return variant_record(variant_, wide);
    for_each_word(record, [&](float& x) { x = math_.read(x); });
    return record;
  }

  PolygonRecord changed(const PolygonRecord& wide, const PolygonRecord& before,
                        const glm::vec3& direction) {
    PolygonRecord record = narrow(wide);
    switch (below(16)) {
      case 0:
        for_each_word(record, [&](float& x) { x = random_number(); });
        break;
      case 1:  // bounds at |U|, or one step off
        for (int k = 0; k < 3; ++k) {
          const float u = variant_.math.dot(record.edges[k], direction);
          record.bounds[k] = stepped(std::abs(u), static_cast<int>(below(3)) - 1);
        }
        break;
      case 2: {  // near the previous distance; near ties differ by up to 64 + 64 steps
        record = before;
        const int reach = 1 << below(9);
        record.d = stepped(record.d,
                           static_cast<int>(below(2 * static_cast<unsigned>(reach) + 1)) - reach);
        break;
      }
      case 3: {
        std::uint32_t word = below(16);
        for_each_word(record, [&](float& x) {
          if (word-- == 0) x = random_number();
        });
        break;
      }
      default:
        break;
    }
    return record;
  }

  const Variant& variant_;
  Arithmetic math_;
  RandomBursts bursts_;
  std::mt19937_64 random_;
};

/// Result of comparing a unit with its reference model.
struct VariantCheck {
  std::uint64_t tests = 0;  // hit tests through unit and model
  HitCounters events{};     // of the pipelined unit: what the sample covers
  std::uint64_t clocks = 0;
  std::string difference = "none";  // the first difference, with its inputs
};

constexpr std::uint64_t kBatch = 5000;

/// Sends about `tests` random and adversarial tests through the Verilated unit and its reference
/// model, and compares every bit of every result, and the events. Half of the records are triangles
/// as the host would send them; the others have replaced words, error bounds close to the edge
/// function's magnitude, distances that are just or just not near ties, and random bits.
VariantCheck check_pipeline(const Variant& variant, BurstUnit& rtl, std::uint64_t tests,
                            std::uint64_t seed) {
  VariantBursts random(variant, seed);
  VariantBurstUnit model(variant.math);
  VariantCheck check;
  while (check.tests < tests && check.difference == "none") {
    const BurstBatch batch = random.make(std::min(kBatch, tests - check.tests));
    check.tests += batch.tests;
    BurstResults expected, got;
    model.run(batch.bundles, expected);
    rtl.run(batch.bundles, got);
    try {
      require_same(batch.bundles, got, expected);
    } catch (const std::exception& error) {
      check.difference = error.what();
    }
  }
  const auto events = [](const HitCounters& c) {
    return std::array{c.tests, c.misses, c.hits, c.edge_doubts, c.depth_doubts};
  };
  check.events = model.counters();
  check.clocks = rtl.counters().clocks;
  if (check.difference == "none" && events(check.events) != events(rtl.counters())) {
    check.difference = "the counts of events differ";
  }
  return check;
}

/// Compares P of random tests with the reference model's, bit by bit.
VariantCheck check_serial(const Variant& variant, PlaneUnit& rtl, std::uint64_t tests,
                          std::uint64_t seed) {
  VariantBursts random(variant, seed);
  VariantPlaneUnit model(variant.math);
  VariantCheck check;
  while (check.tests < tests && check.difference == "none") {
    const BurstBatch batch = random.make(std::min(kBatch, tests - check.tests));
    std::vector<PlaneTest> planes;
    for (const RayBundle& bundle : batch.bundles) {
      for (std::uint32_t i = 0; i < bundle.record_count * kLanes; ++i) {
        const PolygonRecord& record = bundle.records[i / kLanes];
        planes.push_back(
            {bundle.lane_direction(static_cast<int>(i % kLanes)), record.normal, record.d});
      }
    }
    std::vector<glm::vec3> expected(planes.size()), got(planes.size());
    model.intersect(planes, expected);
    rtl.intersect(planes, got);
    check.tests += planes.size();
    for (std::size_t i = 0; i < planes.size() && check.difference == "none"; ++i) {
      if (std::memcmp(&expected[i], &got[i], sizeof got[i]) == 0) continue;
      std::ostringstream text;
      text << std::hexfloat << "P";
      const auto add = [&](const char* name, const glm::vec3& v) {
        text << name << "(" << v.x << ", " << v.y << ", " << v.z << ")";
      };
      add(" of I = ", planes[i].direction);
      add(", N = ", planes[i].normal);
      text << ", d = " << planes[i].d;
      add(" is ", got[i]);
      add(", the model has ", expected[i]);
      check.difference = text.str();
    }
  }
  check.clocks = rtl.clocks();
  return check;
}

VariantCheck check_variant(const Variant& variant, std::uint64_t tests, std::uint64_t seed) {
  if (variant.unit == Variant::Unit::kPipeline) {
    if (const auto rtl = make_rtl_burst_unit(variant)) {
      return check_pipeline(variant, *rtl, tests, seed);
    }
  } else if (const auto rtl = make_rtl_plane_unit(variant)) {
    return check_serial(variant, *rtl, tests, seed);
  }
  return {.difference = "no hardware of it was built"};
}

}  // namespace

std::unique_ptr<HitTester> lab::make_rtl_variant_tester(const Variant& variant) {
  if (variant.unit == Variant::Unit::kSerial) {
    auto unit = make_rtl_plane_unit(variant);
    return unit ? make_variant_tester(variant, std::move(unit)) : nullptr;
  }
  auto unit = make_rtl_burst_unit(variant);
  return unit ? make_variant_tester(variant, std::move(unit)) : nullptr;
}

void lab::add_check(CLI::App& lab) {
  auto* app = lab.add_subcommand("check", "is each variant's reference model its hardware?");
  struct Options {
    std::uint64_t tests = 1'000'000, seed = 1;
  };
  const auto options = std::make_shared<Options>();
  app->add_option("--tests", options->tests, "of each variant");
  app->add_option("--seed", options->seed, "of everything random");
  app->callback([options] {
    for (const Variant& variant : all_variants_of_arithmetic()) {
      if (!variant.has_hardware()) continue;
      const VariantCheck check = check_variant(variant, options->tests, options->seed);
      print({{"table", "checks"},
             {"variant", variant.name},
             {"tests", check.tests},
             {"misses", check.events.misses},
             {"hits", check.events.hits},
             {"doubts", check.events.edge_doubts},
             {"near_ties", check.events.depth_doubts},
             {"clocks", check.clocks},
             {"seed", options->seed},
             {"difference", check.difference}});
    }
  });
}

}  // namespace raygate
