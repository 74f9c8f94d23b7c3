#include "host/lab/core/record_cache.h"

#include <gtest/gtest.h>

namespace raygate::lab {
namespace {

constexpr glm::vec3 kHere{0.0f}, kThere{1.0f};

TEST(RecordCacheTest, TheLeastRecentlyUsedIsGivenUp) {
  RecordCache cache(2);
  cache.use(kHere, 1);
  cache.use(kHere, 2);
  cache.use(kHere, 1);  // here
  cache.use(kHere, 3);  // in place of 2
  cache.use(kHere, 1);  // here
  cache.use(kHere, 2);
  EXPECT_EQ(cache.uses(), 6u);
  EXPECT_DOUBLE_EQ(cache.hits_percent(), 100.0 * 2 / 6);
}

TEST(RecordCacheTest, ARecordIsOfOneOrigin) {
  RecordCache cache(4);
  cache.use(kHere, 1);
  cache.use(kThere, 1);
  EXPECT_DOUBLE_EQ(cache.hits_percent(), 0.0);
  cache.use(kHere, 1);
  EXPECT_DOUBLE_EQ(cache.hits_percent(), 100.0 / 3);
}

TEST(RecordCacheTest, NothingUsedIsNothingFound) {
  EXPECT_DOUBLE_EQ(RecordCache(1).hits_percent(), 0.0);
}

}  // namespace
}  // namespace raygate::lab
