// NameList: names by number, repeated ones kept once.
#include "host/scene/name_list.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "host/base/input_error.h"
#include "host/scene/instances.h"

namespace raygate {
namespace {

TEST(NameList, IsTheListThatItStandsFor) {
  const std::vector<std::string> model = {"leaf", "stem"};
  std::vector<std::string> plain = {"ground"};
  NameList names = {"ground"};
  for (int i = 0; i < 3; ++i) {
    names.push_back(plain.emplace_back("tree " + std::to_string(i)));
    names.append(NameList(model), 4 * i);
    for (int k = 0; k < 4 * i; ++k) plain.insert(plain.end(), model.begin(), model.end());
  }
  names.append({}, 5);
  names.push_back(plain.emplace_back("sky"));
  EXPECT_EQ(names.size(), plain.size());
  EXPECT_EQ(names.all(), plain);
  EXPECT_EQ(NameList().size(), 0u);
}

TEST(NameList, RefusesMoreObjectsThanHaveNumbers) {
  Scene scene;
  scene.objects.append({"one", "two"}, std::size_t{1} << 31);
  EXPECT_EQ(scene.objects[(std::size_t{1} << 32) - 1], "two");
  EXPECT_THROW(require_numbers(scene, "scene.json"), InputError);
  scene.objects = {"one"};
  EXPECT_NO_THROW(require_numbers(scene, "scene.json"));
}

}  // namespace
}  // namespace raygate
