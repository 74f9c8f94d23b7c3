// After any failure, the old file is unchanged.
#include "host/film/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <utility>
#include <vector>

#include "host/base/test/temp_folder.h"

namespace raygate {
namespace {

namespace fs = std::filesystem;

void replace_file(const fs::path& path, std::string_view bytes) {
  AtomicFile(path, bytes).commit();
}

std::string message_of(const fs::path& path, std::string_view bytes) {
  return input_error_of([&] { replace_file(path, bytes); });
}

class AtomicFileTest : public testing::Test {
 protected:
  /// Counts all files, including temporary ones.
  [[nodiscard]] std::size_t file_count() const { return on_disk_.list().size(); }
  [[nodiscard]] std::string read(const std::string& name) const { return on_disk_.read(name); }

 private:
  const TempFolder on_disk_{TempFolder::on_disk()};

 protected:
  const fs::path folder_ = on_disk_.path();
};

TEST_F(AtomicFileTest, WritesANewFile) {
  const std::string bytes("a\0b\r\n", 5);
  replace_file(folder_ / "new", bytes);
  EXPECT_EQ(read("new"), bytes);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, NewFileHasTheUsualPermissions) {
  const mode_t old = ::umask(027);
  replace_file(folder_ / "new", "x");
  ::umask(old);
  struct stat status;
  ASSERT_EQ(::stat((folder_ / "new").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST_F(AtomicFileTest, ChangesNothingBeforeCommit) {
  replace_file(folder_ / "file", "old");
  {
    AtomicFile abandoned(folder_ / "file", "new");
    EXPECT_EQ(read("file"), "old");
  }
  EXPECT_EQ(read("file"), "old");
  EXPECT_EQ(file_count(), 1u);
  AtomicFile first(folder_ / "file", "new");
  AtomicFile second(std::move(first));
  second.commit();
  EXPECT_EQ(read("file"), "new");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, ReplacesAnOldFileAndKeepsItsPermissions) {
  replace_file(folder_ / "file", std::string(100000, 'x'));
  ::chmod((folder_ / "file").c_str(), 0604);
  replace_file(folder_ / "file", "short");
  EXPECT_EQ(read("file"), "short");
  struct stat status;
  ASSERT_EQ(::stat((folder_ / "file").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0604u);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, FollowsSymbolicLinksAlsoToWhatIsNotThereYet) {
  fs::create_directory(folder_ / "disk");
  fs::create_symlink("second", folder_ / "first");
  fs::create_symlink("disk/file", folder_ / "second");
  for (const char* bytes : {"new", "newer"}) {
    require_writable(folder_ / "first");
    replace_file(folder_ / "first", bytes);
    EXPECT_TRUE(fs::is_symlink(folder_ / "first"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "second"));
    EXPECT_EQ(read("disk/file"), bytes);
  }
  fs::create_symlink("round", folder_ / "round");
  EXPECT_EQ(message_of(folder_ / "round", "x"),
            (folder_ / "round").string() + ": cannot write: Too many levels of symbolic links");
}

TEST_F(AtomicFileTest, OtherNamesOfAnOldFileKeepIt) {
  replace_file(folder_ / "file", "old");
  fs::create_hard_link(folder_ / "file", folder_ / "other");
  replace_file(folder_ / "file", "new");
  EXPECT_EQ(read("file"), "new");
  EXPECT_EQ(read("other"), "old");
}

TEST_F(AtomicFileTest, BareNameGoesToTheCurrentFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  require_writable("bare");
  replace_file("bare", "x");
  fs::current_path(before);
  EXPECT_EQ(read("bare"), "x");
}

TEST_F(AtomicFileTest, RequireWritableLeavesNothing) {
  require_writable(folder_ / "new");
  EXPECT_EQ(file_count(), 0u);
  replace_file(folder_ / "old", "old");
  require_writable(folder_ / "old");
  EXPECT_EQ(read("old"), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, RefusesNamesThatNoFileCanHave) {
  replace_file(folder_ / "file", "old");
  const std::pair<fs::path, const char*> names[] = {
      {folder_ / "missing" / "file", "No such file or directory"},
      {folder_ / "file" / "x", "Not a directory"},
      {folder_, "Is a directory"},
      {folder_ / std::string(300, 'n'), "File name too long"}};
  for (const auto& [path, reason] : names) {
    EXPECT_EQ(message_of(path, "x"), path.string() + ": cannot write: " + reason);
    EXPECT_THROW(require_writable(path), InputError);
  }
  EXPECT_EQ(read("file"), "old");
  // This name has the maximum length; the temporary file's name must not be longer.
  replace_file(folder_ / std::string(255, 'n'), "x");
  EXPECT_EQ(read(std::string(255, 'n')), "x");
}

TEST_F(AtomicFileTest, RefusesWithoutPermission) {
  replace_file(folder_ / "file", "old");
  const bool is_root = ::geteuid() == 0;  // root may write anywhere, so become another user
  ::chmod((folder_ / "file").c_str(), 0444);
  ::chmod(folder_.c_str(), 0555);
  if (is_root) {
    ASSERT_EQ(::setresuid(65534, 65534, 0), 0);
  }
  const std::string old_file = message_of(folder_ / "file", "new");
  const std::string new_file = message_of(folder_ / "new", "new");
  const std::string beforehand = input_error_of([&] { require_writable(folder_ / "file"); });
  if (is_root) {
    ASSERT_EQ(::setresuid(0, 0, 0), 0);
  }
  ::chmod(folder_.c_str(), 0755);
  EXPECT_EQ(beforehand, old_file);
  EXPECT_EQ(old_file, (folder_ / "file").string() + ": cannot write: Permission denied");
  EXPECT_EQ(new_file, (folder_ / "new").string() + ": cannot write: Permission denied");
  EXPECT_EQ(read("file"), "old");
  EXPECT_EQ(file_count(), 1u);
}

/// A limit on file sizes simulates a full disk: the write stops half way.
TEST_F(AtomicFileTest, FullDiskLeavesTheOldFile) {
  replace_file(folder_ / "file", "old");
  const auto old_handler = ::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const rlimit limit{4096, old_limit.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  const std::string message = message_of(folder_ / "file", std::string(10000, 'x'));
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  ::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(message, (folder_ / "file").string() + ": cannot write: File too large");
  EXPECT_EQ(read("file"), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFileTest, DevicesAreWrittenToAsTheyAre) {
  require_writable("/dev/full");
  EXPECT_EQ(message_of("/dev/full", "x"), "/dev/full: cannot write: No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(message_of("/dev/null", "x"), "(read)");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

/// Opening a pipe without a reader would normally block for ever.
TEST_F(AtomicFileTest, APipeThatNobodyReadsIsRefused) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(message_of(pipe, "x"), pipe.string() + ": cannot write: nobody reads it");
  EXPECT_THROW(require_writable(pipe), InputError);
}

TEST_F(AtomicFileTest, APipesReaderGetsTheBytesThoughItWasAskedBefore) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  require_writable(pipe);
  char bytes[8] = {};
  EXPECT_EQ(::read(reader, bytes, sizeof bytes), -1) << "the end, before anything came";
  replace_file(pipe, "abc");
  EXPECT_EQ(::read(reader, bytes, sizeof bytes), 3);
  EXPECT_STREQ(bytes, "abc");
  ::close(reader);
}

TEST_F(AtomicFileTest, InputsAreNoOutputsUnderWhateverName) {
  replace_file(folder_ / "in.mtl", "old");
  fs::create_hard_link(folder_ / "in.mtl", folder_ / "hard");
  fs::create_symlink("in.mtl", folder_ / "soft");
  const std::vector<fs::path> inputs{folder_ / "gone", folder_ / "in.mtl"};
  for (const char* name : {"in.mtl", "hard", "soft"}) {
    const std::vector<fs::path> outputs{folder_ / "new", folder_ / name};
    EXPECT_EQ(input_error_of([&] { require_distinct(outputs, inputs); }),
              (folder_ / name).string() + ": would overwrite " + (folder_ / "in.mtl").string());
  }
  require_distinct(std::vector<fs::path>{folder_ / "new"}, inputs);
  fs::create_symlink("new", folder_ / "other");  // link to a file that does not exist yet
  const fs::path link = folder_ / "other", file = folder_ / "new";
  EXPECT_EQ(input_error_of([&] {
              require_distinct({&link, 1}, {&file, 1});
            }),
            link.string() + ": would overwrite " + file.string());
}

}  // namespace
}  // namespace raygate
