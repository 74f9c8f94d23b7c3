// The digest of a scene depends on the contents of its files and on the settings of its scene file.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "host/base/input_error.h"
#include "host/base/test/temp_folder.h"
#include "host/scene/scene.h"

namespace raygate {
namespace {

using Paths = std::vector<std::filesystem::path>;

TEST(Digest, DependsOnContentsAlone) {
  const TempFolder folder;
  const Paths files{folder.write("a.obj", "v 0 0 0"), folder.write("a.mtl", "newmtl m")};
  const std::string digest = digest_of(files, "{}");
  EXPECT_EQ(digest.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(digest.size(), 16u);
  EXPECT_EQ(digest, digest_of(Paths{folder.write("b.mtl", "newmtl m"), files[0]}, "{}"))
      << "in any order and under any name";
  std::set<std::string> seen{digest, digest_of(files, ""), digest_of(Paths{files[0]}, "{}")};
  for (const char* text : {"v 0 0 1", "v 0 0 00", "v 0 0 ", "V 0 0 0", "v 0 0 0 0 0 0 0 0"}) {
    folder.write("a.obj", text);
    EXPECT_TRUE(seen.insert(digest_of(files, "{}")).second) << text;
  }
  EXPECT_EQ(seen.size(), 8u);
  EXPECT_THROW((void)digest_of(Paths{folder.path() / "absent"}, ""), InputError);
}

}  // namespace
}  // namespace raygate
