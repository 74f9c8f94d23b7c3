// Reads files of encode_exr back with the library.
#include "host/film/exr.h"

#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <bit>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "host/film/test/exr_reader.h"
#include "host/film/test/sample_film.h"

namespace raygate {
namespace {

/// Expects equal bits in every pixel, including NaN, infinities and subnormals.
template <typename Get>
void expect_same_bits(const std::vector<float>& actual, std::size_t count, Get expected) {
  ASSERT_EQ(actual.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(actual[i]), std::bit_cast<std::uint32_t>(expected(i)))
        << "pixel " << i;
  }
}

void expect_all_channels_kept(const Film& film) {
  ExrReader reader(encode_exr(film, {}));
  const auto expect = [&](const std::string& name, const auto& values, const auto& get) {
    SCOPED_TRACE(name);
    if (values.empty()) return;
    expect_same_bits(reader.read<float>(name.c_str(), Imf::FLOAT), film.color.size(),
                     [&](std::size_t i) { return get(values[i]); });
  };
  for (int k = 0; k < 4; ++k) {
    const auto part = [k](const auto& vector) { return vector[k]; };
    expect(std::string(1, "RGBA"[k]), film.color, part);
    if (k == 3) continue;
    expect(std::string("N.") + "XYZ"[k], film.normal, part);
    expect(std::string("P.") + "XYZ"[k], film.position, part);
    expect(std::string("Albedo.") + "RGB"[k], film.albedo, part);
  }
  expect("Z", film.depth, [](float z) { return z; });
  EXPECT_EQ(reader.read<std::uint32_t>("id", Imf::UINT), film.primitive);
}

TEST(Exr, KeepsEveryBitOfEveryChannel) {
  expect_all_channels_kept(make_sample_film(67, 41, {0, 0, 67, 41}));
  expect_all_channels_kept(make_sample_film(1, 1, {0, 0, 1, 1}));
}

std::set<std::string> channel_names(const Film& film) {
  const ExrReader reader(encode_exr(film, {}));
  std::set<std::string> names;
  const Imf::ChannelList& channels = reader.header().channels();
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    names.insert(channel.name());
  }
  return names;
}

TEST(Exr, ChannelsOnDemandAreThereWhereTheFilmHasThem) {
  std::set<std::string> names{"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "id"};
  EXPECT_EQ(channel_names(make_sample_film(5, 4, {0, 0, 5, 4})), names);
  const Film film = make_sample_film(40, 30, {3, 7, 40, 30}, true);
  names.insert(
      {"P.X", "P.Y", "P.Z", "Albedo.R", "Albedo.G", "Albedo.B", "objectId", "tests", "doubts"});
  EXPECT_EQ(channel_names(film), names);
  expect_all_channels_kept(film);
  ExrReader reader(encode_exr(film, {}));
  EXPECT_EQ(reader.read<std::uint32_t>("objectId", Imf::UINT), film.object);
  EXPECT_EQ(reader.read<std::uint32_t>("tests", Imf::UINT), film.tests);
  EXPECT_EQ(reader.read<std::uint32_t>("doubts", Imf::UINT), film.doubts);
}

TEST(Exr, CropIsTheDataWindow) {
  const Film film = make_sample_film(640, 480, {600, 17, 633, 57});
  expect_all_channels_kept(film);
  ExrReader reader(encode_exr(film, {}));
  EXPECT_EQ(reader.header().displayWindow(), Imath::Box2i({0, 0}, {639, 479}));
  EXPECT_EQ(reader.header().dataWindow(), Imath::Box2i({600, 17}, {632, 56}));
}

TEST(Exr, CarriesSceneAndCamera) {
  const glm::mat4 world_to_camera =
      glm::lookAt(glm::vec3(1, 2, 3), glm::vec3(-4, 0, 2), glm::vec3(0, 1, 0));
  ExrReader reader(encode_exr(make_sample_film(2, 2, {0, 0, 2, 2}),
                              {.attributes = {{"software", "raygate 1.2"}, {"spp", "4"}},
                               .world_to_camera = world_to_camera,
                               .screen_window_width = 0.75f}));
  EXPECT_EQ(reader.text("software"), "raygate 1.2");
  EXPECT_EQ(reader.text("spp"), "4");
  ASSERT_TRUE(Imf::hasWorldToCamera(reader.header()));
  EXPECT_EQ(reader.header().screenWindowWidth(), 0.75f);
  // Imath's product with a row vector and glm's with a column vector give the same point.
  const glm::vec3 expected = glm::vec3(world_to_camera * glm::vec4(5, 6, 7, 1));
  const Imath::V3f actual = Imath::V3f(5, 6, 7) * Imf::worldToCamera(reader.header());
  EXPECT_NEAR(actual.x, expected.x, 1e-5f);
  EXPECT_NEAR(actual.y, expected.y, 1e-5f);
  EXPECT_NEAR(actual.z, expected.z, 1e-5f);
}

TEST(Exr, EqualFilmsGiveEqualBytes) {
  Film film = make_sample_film(50, 40, {0, 0, 50, 40});
  const std::string first = encode_exr(film, {});
  EXPECT_EQ(first, encode_exr(Film(film), {}));
  film.normal[7].z = -film.normal[7].z;
  EXPECT_NE(first, encode_exr(film, {}));
}

TEST(Exr, ThreadsChangeNoByte) {
  for (const PixelRect window : {PixelRect{0, 0, 50, 100}, PixelRect{7, 3, 9, 36}}) {
    const Film film = make_sample_film(50, 100, window);
    EXPECT_EQ(encode_exr(film, {}), encode_exr(film, {}, 3));
  }
}

}  // namespace
}  // namespace raygate
