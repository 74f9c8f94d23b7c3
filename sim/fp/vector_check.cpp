#include "sim/fp/vector_check.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <istream>
#include <ostream>
#include <string>

#include "host/base/input_error.h"

namespace raygate {
namespace {

constexpr std::string_view kBlanks = " \t\r";

// Takes a line apart, and complains with its number.
class LineReader {
 public:
  LineReader(std::string_view name, std::size_t line, std::string_view text)
      : name_(name), line_(line), rest_(text) {}

  /// The next field, which must be `digits` hexadecimal digits and no more than `limit`.
  std::uint32_t field(const char* what, std::size_t digits, std::uint32_t limit) {
    const std::size_t begin = std::min(rest_.find_first_not_of(kBlanks), rest_.size());
    rest_.remove_prefix(begin);
    const std::string_view text = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(text.size());
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (text.size() != digits || error != std::errc() || end != text.data() + text.size() ||
        value > limit) {
      fail(std::string(what) + " is \"" + std::string(text) + "\", expected " +
           std::to_string(digits) + " hexadecimal digits" + highest(digits, limit));
    }
    return value;
  }

  void end() const {
    if (rest_.find_first_not_of(kBlanks) != std::string_view::npos) {
      fail("more than two operands, a result and flags");
    }
  }

 private:
  // Says the limit where the digits alone don't.
  static std::string highest(std::size_t digits, std::uint32_t limit) {
    if (digits == 8 || limit == (1u << 4 * digits) - 1) return "";
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), " up to %x", limit);
    return text.data();
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(std::string(name_), line_, what);
  }

  std::string_view name_;
  std::size_t line_;
  std::string_view rest_;
};

bool same(FloatFormat format, const VectorCheckOptions& options, FloatResult got,
          FloatResult expected) {
  if (got.flags != expected.flags) return false;
  const bool any_nan = !options.check_nans && !is_comparison(options.op);
  return got.bits == expected.bits ||
         (any_nan && format.is_nan(got.bits) && format.is_nan(expected.bits));
}

}  // namespace

const std::vector<VectorFunction>& vector_functions() {
  static const std::vector<VectorFunction> functions = {
      {"f32_add", kBinary32, FloatOp::kAdd}, {"f32_sub", kBinary32, FloatOp::kSub},
      {"f32_mul", kBinary32, FloatOp::kMul}, {"f32_div", kBinary32, FloatOp::kDiv},
      {"f32_eq", kBinary32, FloatOp::kEq},   {"f32_lt", kBinary32, FloatOp::kLt},
      {"f32_le", kBinary32, FloatOp::kLe},   {"f16_add", kBinary16, FloatOp::kAdd},
      {"f16_sub", kBinary16, FloatOp::kSub}, {"f16_mul", kBinary16, FloatOp::kMul},
      {"f16_div", kBinary16, FloatOp::kDiv}, {"f16_eq", kBinary16, FloatOp::kEq},
      {"f16_lt", kBinary16, FloatOp::kLt},   {"f16_le", kBinary16, FloatOp::kLe}};
  return functions;
}

VectorCheckSummary check_vectors(std::istream& in, std::string_view name, FloatCores& cores,
                                 const VectorCheckOptions& options, std::ostream& out) {
  const FloatFormat format = cores.format();
  const int digits = format.width() / 4;
  const int result_digits = is_comparison(options.op) ? 1 : digits;
  const std::uint32_t result_limit = is_comparison(options.op) ? 1 : format.mask();
  VectorCheckSummary summary;
  std::string line;
  while (std::getline(in, line)) {
    ++summary.vectors;
    LineReader reader(name, summary.vectors, line);
    const std::uint32_t a = reader.field("the first operand", digits, format.mask());
    const std::uint32_t b = reader.field("the second operand", digits, format.mask());
    FloatResult expected;
    expected.bits = reader.field("the result", result_digits, result_limit);
    expected.flags = static_cast<std::uint8_t>(reader.field("the flags field", 2, 0x1f));
    reader.end();

    const FloatResult got = cores.run(options.op, a, b, options.rounding, options.tininess);
    if (same(format, options, got, expected)) continue;
    if (++summary.differences > options.max_shown) continue;
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(),
                  "line %llu: %0*X %0*X: expected %0*X %02X, got %0*X %02X\n",
                  static_cast<unsigned long long>(summary.vectors), digits, a, digits, b,
                  result_digits, expected.bits, expected.flags, result_digits, got.bits, got.flags);
    out << text.data();
  }
  return summary;
}

}  // namespace raygate
