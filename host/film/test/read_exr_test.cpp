// Reads valid and invalid EXR files.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <random>

#include "host/base/test/temp_folder.h"
#include "host/film/exr.h"
#include "host/film/test/sample_film.h"

namespace raygate {
namespace {

class ExrFile : public testing::Test {
 protected:
  [[nodiscard]] std::string error_of(const std::filesystem::path& file) const {
    return folder_.error_of([&] { (void)read_exr(file); });
  }

  const TempFolder folder_;
};

TEST_F(ExrFile, ReadsWhatWasWritten) {
  const Film film = make_sample_film(64, 48, {5, 7, 60, 40}, true);
  const auto file = folder_.write("a.exr", encode_exr(film, {}));
  const EnvironmentMap picture = read_exr(file);
  EXPECT_EQ(picture.width, 55);
  EXPECT_EQ(picture.height, 33);
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    ASSERT_EQ(picture.texels[i], glm::vec3(film.color[i]));
  }
}

TEST_F(ExrFile, BadFilesAreRefusedInOneLine) {
  EXPECT_EQ(error_of(folder_.path() / "none.exr"),
            "none.exr: cannot read: No such file or directory");
  std::filesystem::create_directory(folder_.path() / "d.exr");
  EXPECT_EQ(error_of(folder_.path() / "d.exr"), "d.exr: cannot read: it is a folder");
  ASSERT_EQ(::mkfifo((folder_.path() / "p.exr").c_str(), 0600), 0);
  EXPECT_EQ(error_of(folder_.path() / "p.exr"),
            "p.exr: cannot read: it is a device, a pipe or a socket");
  EXPECT_EQ(error_of(folder_.write("t.exr", "text")), "t.exr: not an OpenEXR file");
  EXPECT_EQ(error_of(folder_.write("e.exr", "")), "e.exr: not an OpenEXR file");
  std::string bytes = encode_exr(make_sample_film(20, 10, {0, 0, 20, 10}), {});
  bytes.replace(bytes.find(std::string("R\0", 2)), 1, "S");
  EXPECT_EQ(error_of(folder_.write("a.exr", bytes)),
            "a.exr: no channel R; the file has A, B, G, N.X, N.Y, N.Z, S, Z, id");
}

/// Lengths are checked before memory is allocated. A file of 2,634 bytes from fuzzing took 2 GB.
TEST_F(ExrFile, HeadersAreNoLongerThanTheFile) {
  std::string bytes = encode_exr(make_sample_film(20, 10, {0, 0, 20, 10}),
                                 {.attributes = {{"scene", "cornell.obj"}}});
  const std::size_t length = bytes.find(std::string("scene\0string\0", 13)) + 13;
  ASSERT_EQ(bytes[length], 11);
  bytes.replace(length, 4, "ring");
  EXPECT_EQ(error_of(folder_.write("x.exr", bytes)),
            "x.exr: damaged: Attribute type vs. size mismatch");
  bytes = encode_exr(make_sample_film(20, 10, {0, 0, 20, 10}), {});
  const std::size_t box = bytes.find(std::string("dataWindow\0box2i\0", 17)) + 17;
  bytes[box] = 20;  // instead of 16
  bytes.insert(box + 4, 4, '\0');
  EXPECT_EQ(error_of(folder_.write("y.exr", bytes)),
            "y.exr: damaged: Attribute type vs. size mismatch");
}

/// Files that are cut or changed anywhere are read, or refused with one line.
TEST_F(ExrFile, DamagedFilesNeverCrash) {
  const std::string bytes = encode_exr(make_sample_film(20, 10, {0, 0, 20, 10}), {});
  std::mt19937_64 random(11);
  int refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::string damaged = bytes;
    if (round % 2 == 0) {
      damaged.resize(random() % bytes.size());
    } else {
      for (int i = 0; i < 3; ++i) damaged[random() % bytes.size()] = static_cast<char>(random());
    }
    const std::string error = error_of(folder_.write("x.exr", damaged));
    refused += error != "(read)";
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  EXPECT_GT(refused, 150);
}

}  // namespace
}  // namespace raygate
