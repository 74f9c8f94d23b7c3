// Lines and tokens of text files.
#include "host/scene/io/text.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "host/base/test/temp_folder.h"

namespace raygate {
namespace {

using Statements = std::vector<std::pair<std::size_t, std::string>>;

Statements statements_of(std::string_view bytes) {
  const TempFolder folder;
  TextLines lines(folder.write("text", bytes));
  Statements statements;
  while (const auto statement = lines.next()) {
    statements.emplace_back(statement->line(), std::string(statement->rest()));
  }
  return statements;
}

std::string reading_error_of(const std::filesystem::path& file) {
  return input_error_of([&] { TextLines lines(file); });
}

TEST(TextLines, EndInLfCrOrBoth) {
  const Statements expected{{1, "a"}, {2, "b"}, {4, "c"}};
  EXPECT_EQ(statements_of("a\nb\n\nc"), expected);
  EXPECT_EQ(statements_of("a\nb\n\nc\n"), expected);
  EXPECT_EQ(statements_of("a\rb\r\rc\r"), expected);
  EXPECT_EQ(statements_of("a\r\nb\r\n\r\nc\r\n"), expected);
  EXPECT_EQ(statements_of("a\r\nb\n\rc\n"), expected);
}

TEST(TextLines, SkipBlanksAndComments) {
  EXPECT_EQ(statements_of("# one\n  \t\n\t two  \n  # three\nfour # five\n"),
            (Statements{{3, "two"}, {5, "four # five"}}));
  EXPECT_EQ(statements_of("\n\n"), Statements{});
}

TEST(TextLines, SkipAByteOrderMark) {
  EXPECT_EQ(statements_of("\xEF\xBB\xBFv 1"), (Statements{{1, "v 1"}}));
}

TEST(TextLines, AreJoinedByABackslash) {
  EXPECT_EQ(statements_of("f 1 2 \\\n3 4\\\r\n5\nnext"),
            (Statements{{1, "f 1 2  3 4 5"}, {4, "next"}}));
  EXPECT_EQ(statements_of("f 1 \\"), (Statements{{1, "f 1"}}));
  EXPECT_EQ(statements_of("\\\n\\\n\nv"), (Statements{{4, "v"}}));
}

TEST(TextLines, ACommentThatEndsInABackslashEndsThere) {
  EXPECT_EQ(statements_of("# made in C:\\models\\\nv 1"), (Statements{{2, "v 1"}}));
  EXPECT_EQ(statements_of("f 1 2 3 # C:\\\nv 1"), (Statements{{1, "f 1 2 3 # C:\\"}, {2, "v 1"}}));
  EXPECT_EQ(statements_of("g a#b\\\nc"), (Statements{{1, "g a#b c"}}));
}

TEST(TextLines, RefuseWhatIsNoText) {
  const TempFolder folder;
  const std::string path = folder.path().string();
  EXPECT_EQ(reading_error_of(folder.write("empty", "")), path + "/empty: the file is empty");
  EXPECT_EQ(reading_error_of(folder.path()), path + ": is a folder, expected a file");
  EXPECT_EQ(reading_error_of(folder.path() / "none"),
            path + "/none: cannot read: No such file or directory");
  EXPECT_EQ(reading_error_of("/dev/zero"), "/dev/zero: is a device, expected a file");
  EXPECT_EQ(reading_error_of(folder.write("nul", std::string_view("v\nv\n\0\nv", 7))),
            path + "/nul:3: a byte of value 0: not a text file");
  EXPECT_EQ(reading_error_of(folder.write("wide", std::string_view("\xFF\xFEv\0", 4))),
            path + "/wide:1: UTF-16 text, expected ASCII or UTF-8");
}

// If the search for each line's end went to the end of the file, this would take minutes.
TEST(TextLines, ManyLinesEndedByCrAlone) {
  std::string text;
  for (int i = 0; i < 1000000; ++i) text += "v 1\r";
  EXPECT_EQ(statements_of(text).back().first, 1000000u);
}

TEST(Words, AreTakenOneByOne) {
  const std::string file = "a.obj";
  Words words(file, "usemtl\t a  b", 7);
  EXPECT_EQ(words.take(), "usemtl");
  EXPECT_EQ(words.rest(), "a  b");
  EXPECT_TRUE(words.take_if("a"));
  EXPECT_FALSE(words.take_if("a"));
  EXPECT_EQ(words.take(), "b");
  EXPECT_TRUE(words.at_end());
  EXPECT_EQ(words.take(), "");
  EXPECT_EQ(words.rest(), "");
  EXPECT_EQ(words.place(), "a.obj:7: ");
}

TEST(Words, ACommentEndsThem) {
  const std::string file = "a.obj";
  Words words(file, "1 2#3 #4 5");
  words.drop_comment();
  EXPECT_EQ(words.take(), "1");
  EXPECT_EQ(words.take(), "2#3");
  EXPECT_TRUE(words.at_end());
}

}  // namespace
}  // namespace raygate
