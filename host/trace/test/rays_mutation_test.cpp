// Damaged tables can be traced or are refused with one line. Large tables take little memory.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>

#include "host/base/input_error.h"
#include "host/base/test/damage.h"
#include "host/trace/ray_table.h"

namespace raygate {
namespace {

constexpr std::string_view kCsv =
    "ox,oy,oz,dx,dy,dz,limit\n# a comment\n1,2,3,0,0,-1\r\n +4 , 5e0,6, 3,0,0, 2\n"
    "0,0,0,1,1,0.25,inf\n\n7,8,9,0,0,0\n0.5,0,0,0,-0.125,0,1e-3\n";
constexpr const char* kSplinters[] = {"1e38", "1e39", "-0", ",", ",,",   "\n",   "\r",
                                      "#",    " ",    "--", "+", "0x10", "\xFF", "'"};

/// The result of reading a table: its rays, or an error.
struct Outcome {
  std::vector<Ray> rays;
  std::vector<double> limits;
  std::string error;
};

class DamagedRays : public testing::Test {
 protected:
  void TearDown() override { close(file_); }

  void write(std::string_view bytes) const {
    ASSERT_EQ(ftruncate(file_, 0), 0);
    ASSERT_EQ(pwrite(file_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }

  Outcome read(std::size_t most) const {
    Outcome outcome;
    try {
      RayTableReader rays(path_, glm::dvec3(0.0));
      for (RayTable block; rays.read(most, block);) {
        outcome.rays.insert(outcome.rays.end(), block.rays.begin(), block.rays.end());
        outcome.limits.insert(outcome.limits.end(), block.limits.begin(), block.limits.end());
      }
    } catch (const InputError& error) {
      outcome.error = error.what();
    }
    return outcome;
  }

  int file_ = memfd_create("rays", 0);  // in memory, because thousands of tables are written
  std::filesystem::path path_ = "/proc/self/fd/" + std::to_string(file_);
  test::Damage damage_{20261122, kSplinters};
};

TEST_F(DamagedRays, CanBeTracedOrAreRefused) {
  int usable = 0, refused = 0;
  for (int round = 0; round < 8000; ++round) {
    write(damage_(std::string(kCsv), 90));
    const Outcome outcome = read(3);
    for (const Ray& ray : outcome.rays) {
      ASSERT_TRUE(std::isfinite(ray.origin.x) && std::isfinite(ray.origin.y) &&
                  std::isfinite(ray.origin.z));
      ASSERT_TRUE(!is_usable(ray.direction) || is_scaled(ray.direction)) << "round " << round;
    }
    for (const double limit : outcome.limits) ASSERT_GT(limit, 0.0) << "round " << round;
    ++(outcome.error.empty() ? usable : refused);
    if (!outcome.error.empty()) {
      ASSERT_TRUE(outcome.error.starts_with(path_.string() + ":")) << outcome.error;
      ASSERT_TRUE(
          std::ranges::none_of(outcome.error, [](unsigned char c) { return c < ' ' || c == 0x7F; }))
          << "round " << round << ": " << outcome.error;
    }
    if (round % 8 != 0) continue;
    const Outcome whole = read(1000);
    ASSERT_EQ(whole.error, outcome.error);
    ASSERT_TRUE(!whole.error.empty() || whole.rays.size() == outcome.rays.size());
  }
  EXPECT_GT(usable, 1000);
  EXPECT_GT(refused, 1000);
}

/// Returns the peak memory use of this process so far, in bytes.
long most_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024;
}

TEST_F(DamagedRays, LargeOnesTakeNoMemory) {
  constexpr off_t kLarge = off_t{1} << 27;
  constexpr long kAllowed = 1 << 24;
  write("0,0,0,0,0,1\n");
  (void)read(1 << 14);
  const long before = most_memory();
  // Zero bytes without an end of line.
  ASSERT_EQ(ftruncate(file_, kLarge), 0);
  EXPECT_NE(read(1 << 14).error.find(":2: found a line of over 1,000,000 bytes"),
            std::string::npos);
  EXPECT_LT(most_memory() - before, kAllowed);
}

}  // namespace
}  // namespace raygate
