// The words of a statement: keywords, numbers, what they look like in a message.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/scene/io/text_lines.h"

namespace raygate {

/// Takes the first word (up to a space or tab) off `text`, and the spaces and tabs after it.
/// An empty word: nothing was left.
[[nodiscard]] std::string_view take_token(std::string_view& text);

/// The same, but a word that begins with # ends the statement: the rest is a comment.
[[nodiscard]] std::string_view take_token_before_comment(std::string_view& text);

/// 'word' for a message: cut to 40 characters, what cannot be printed as \xHH.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// A decimal number to the nearest double, whatever the locale; too small a one is 0. nullopt: not
/// a number as a whole. "nan" and "inf" are numbers, and so is one that overflows to infinity.
[[nodiscard]] std::optional<double> to_number(std::string_view word);

/// The word as a finite number within the range of float; else an error that says what it is
/// the number of ("Kd").
[[nodiscard]] double expect_number(const TextLines& lines, std::string_view word,
                                   std::string_view of_what);

}  // namespace raygate
