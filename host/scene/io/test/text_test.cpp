// Lines, tokens and numbers of text files.
#include "host/scene/io/text.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "host/base/input_error.h"
#include "host/base/test/temp_folder.h"

namespace raygate {
namespace {

using Statements = std::vector<std::pair<std::size_t, std::string>>;

Statements statements_of(std::string_view bytes) {
  const TempFolder folder;
  TextLines lines(folder.write("text", bytes));
  Statements statements;
  while (const auto statement = lines.next()) {
    statements.emplace_back(lines.line(), std::string(*statement));
  }
  return statements;
}

std::string reading_error_of(const std::filesystem::path& file) {
  try {
    TextLines lines(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
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

// Were each line searched for its end to the end of the file, this would take minutes.
TEST(TextLines, ManyLinesEndedByCrAlone) {
  std::string text;
  for (int i = 0; i < 1000000; ++i) text += "v 1\r";
  EXPECT_EQ(statements_of(text).back().first, 1000000u);
}

TEST(Words, AreTakenOneByOne) {
  std::string_view text = "usemtl\t a  b ";
  EXPECT_EQ(take_token(text), "usemtl");
  EXPECT_EQ(text, "a  b ");
  EXPECT_EQ(take_token(text), "a");
  EXPECT_EQ(take_token(text), "b");
  EXPECT_EQ(take_token(text), "");
}

TEST(Words, ACommentEndsThem) {
  std::string_view text = "1 2#3 #4 5";
  EXPECT_EQ(take_token_before_comment(text), "1");
  EXPECT_EQ(take_token_before_comment(text), "2#3");
  EXPECT_EQ(take_token_before_comment(text), "");
  EXPECT_EQ(take_token_before_comment(text), "");
}

TEST(Quotes, ShowWhatCannotBePrinted) {
  EXPECT_EQ(in_quotes("abc"), "'abc'");
  EXPECT_EQ(in_quotes("a\x01\x7f"), "'a\\x01\\x7F'");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(Numbers, AreReadToTheNearestDouble) {
  EXPECT_EQ(to_number("1"), 1.0);
  EXPECT_EQ(to_number("+1.5"), 1.5);
  EXPECT_EQ(to_number("-.5e1"), -5.0);
  EXPECT_EQ(to_number("7."), 7.0);
  EXPECT_EQ(to_number("0.1"), 0.1);
  EXPECT_EQ(to_number("123456.78901234567"), 123456.78901234567);
  EXPECT_EQ(to_number("9007199254740993"), 9007199254740992.0);              // a tie: to even
  EXPECT_EQ(to_number("2.2250738585072011e-308"), 2.2250738585072011e-308);  // subnormal
}

TEST(Numbers, TooSmallIsZeroTooLargeIsInfinite) {
  EXPECT_EQ(to_number("1e-400"), 0.0);
  EXPECT_TRUE(std::signbit(*to_number("-1e-99999999999")));
  EXPECT_EQ(to_number("0." + std::string(400, '0') + "1"), 0.0);
  EXPECT_EQ(to_number("1e400"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_number("1" + std::string(400, '0')), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(*to_number("nan")));
  EXPECT_TRUE(std::isinf(*to_number("-inf")));
}

TEST(Numbers, AreWholeWords) {
  for (const char* word : {"", "+", "-", "+-1", "--1", "1e", "1e+", "1,5", "0x10", "1f", "1 ", "a",
                           ".", "1_000", "1.2.3", "1d3"}) {
    EXPECT_EQ(to_number(word), std::nullopt) << word;
  }
}

TEST(Numbers, DoNotDependOnTheLocale) {
  // Whichever of these is installed has a decimal comma.
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"}) {
    if (std::setlocale(LC_ALL, name)) break;
  }
  EXPECT_EQ(to_number("1.5"), 1.5);
  EXPECT_EQ(to_number("1.5e-400"), 0.0);
  EXPECT_EQ(to_number("1.5e400"), std::numeric_limits<double>::infinity());
  std::setlocale(LC_ALL, before.c_str());
}

}  // namespace
}  // namespace raygate
