#include "host/trace/ray_table.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "host/base/input_error.h"

namespace raygate {

void RayTable::clear(std::uint64_t its_first) {
  first = its_first;
  rays.clear();
  limits.clear();
  exponents.clear();
  rounded = 0;
}

const char* RayTable::add(const glm::dvec3& origin, const glm::dvec3& direction, double limit,
                          const glm::dvec3& scene_origin) {
  const auto is_finite = [](const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  if (!is_finite(origin) || !is_finite(direction)) {
    return "found inf or nan in origin or direction, expected finite numbers";
  }
  if (!(limit > 0.0)) return "found a limit that is not above 0, expected one, or inf";
  if (largest(origin - scene_origin) > kMostCoordinate) {
    return "found an origin farther than 2^126 from the scene, expected a nearer one";
  }
  const RecentredPosition start = recentred(origin, scene_origin);
  Ray ray{.origin = start.position};
  int exponent = 0;
  if (direction != glm::dvec3(0.0)) {
    ray.direction = scaled_direction(direction);
    // The ratio is a power of two, up to the rounding of the direction.
    exponent = static_cast<int>(
        std::lround(std::log2(largest(glm::dvec3(ray.direction))) - std::log2(largest(direction))));
  }
  const auto as_given = [&](float x) { return std::ldexp(double{x}, -exponent); };
  const glm::dvec3 kept(as_given(ray.direction.x), as_given(ray.direction.y),
                        as_given(ray.direction.z));
  const double scaled_limit = std::ldexp(limit, -exponent);
  const float float_limit =
      std::max(static_cast<float>(scaled_limit), std::numeric_limits<float>::denorm_min());
  rounded += start.error != 0.0 || kept != direction ||
             (double{float_limit} != scaled_limit && std::isfinite(float_limit));
  rays.push_back(ray);
  limits.push_back(float_limit);
  exponents.push_back(exponent);
  return nullptr;
}

namespace {

constexpr int kMostNumbers = 7;
constexpr const char* kWanted = "OX,OY,OZ,DX,DY,DZ or OX,OY,OZ,DX,DY,DZ,LIMIT";

/// Buffered bytes of a file or of standard input.
class Bytes {
 public:
  explicit Bytes(const std::filesystem::path& file)
      : name_(file == "-" ? "standard input" : file.string()),
        file_(file == "-" ? stdin : std::fopen(file.c_str(), "rb")) {
    if (file_ == nullptr) fail(errno);
  }
  ~Bytes() {
    if (file_ != stdin) std::fclose(file_);
  }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }

  /// Returns at least `count` bytes (at most kMost), or all that remain. Valid until the next call.
  std::string_view peek(std::size_t count) {
    while (text_.size() - begin_ < count && !at_end_) {
      if (begin_ > kMost) text_.erase(0, std::exchange(begin_, 0));
      const std::size_t old = text_.size();
      text_.resize(old + kPiece);
      const std::size_t got = std::fread(text_.data() + old, 1, kPiece, file_);
      text_.resize(old + got);
      if (got < kPiece && std::ferror(file_) != 0) fail(errno);
      at_end_ = got == 0;
    }
    return std::string_view(text_).substr(begin_);
  }
  void skip(std::size_t count) { begin_ += count; }

  static constexpr std::size_t kMost = std::size_t{1} << 20;

 private:
  [[noreturn]] void fail(int error) const {
    throw InputError(name_ + ": cannot read: " + std::generic_category().message(error));
  }

  static constexpr std::size_t kPiece = std::size_t{1} << 18;
  std::string name_, text_;
  std::FILE* file_;
  std::size_t begin_ = 0;
  bool at_end_ = false;
};

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view unquoted(std::string_view text) {
  const bool is_quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
                         text.back() == text.front();
  return is_quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

std::optional<double> number_of(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return {};
  return value;
}

bool begins_as_number(std::string_view text) {
  return text.empty() ||
         std::string_view("0123456789+-.").find(text.front()) != std::string_view::npos;
}

/// Returns a word for an error message, shortened and on one line.
std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string word = "'";
  for (const char c : text.substr(0, kMost)) {
    const auto byte = static_cast<unsigned char>(c);
    word += byte < ' ' || byte == 0x7F ? '?' : c;
  }
  word += text.size() > kMost ? "...'" : "'";
  return word;
}

}  // namespace

/// Base of the readers of the table formats.
class RayTableReader::Source {
 public:
  virtual ~Source() = default;
  /// Reads the next row of 6 or 7 numbers. Returns their count, or 0 at the end.
  virtual int next(double (&numbers)[kMostNumbers]) = 0;
  /// Throws InputError about the last row.
  [[noreturn]] virtual void fail(const std::string& what) const = 0;
};

class RayTableReader::CsvSource : public RayTableReader::Source {
 public:
  /// Skips a byte order mark.
  explicit CsvSource(std::unique_ptr<Bytes> bytes) : bytes_(std::move(bytes)) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    const std::string_view start = bytes_->peek(kMark.size());
    if (start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF")) {
      throw InputError(bytes_->name() + ": found UTF-16 text, expected ASCII or UTF-8");
    }
    if (start.starts_with(kMark)) bytes_->skip(kMark.size());
  }

  int next(double (&numbers)[kMostNumbers]) override {
    while (true) {
      std::string_view text = bytes_->peek(1);
      if (text.empty()) return 0;
      ++line_;
      std::size_t end = text.find('\n');
      if (end == std::string_view::npos) {
        text = bytes_->peek(Bytes::kMost);
        end = text.find('\n');
        if (end == std::string_view::npos) end = text.size();
        if (end >= Bytes::kMost) fail("found a line of over 1,000,000 bytes, expected " + wanted());
      }
      const std::string_view line = trimmed(text.substr(0, end));
      bytes_->skip(std::min(end + 1, text.size()));
      if (line.empty() || line.front() == '#') continue;
      if (const int count = split(line, numbers)) return count;
    }
  }

  [[noreturn]] void fail(const std::string& what) const override {
    throw InputError(bytes_->name(), line_, what);
  }

 private:
  static std::string wanted() { return kWanted; }

  /// Reads the numbers of a line. Returns their count, or 0 for a header.
  int split(std::string_view line, double (&numbers)[kMostNumbers]) {
    std::string_view wrong;
    int count = 0;
    bool is_header = !std::exchange(past_header_, true);
    const char* const separators = line.find(',') != std::string_view::npos   ? ","
                                   : line.find(';') != std::string_view::npos ? ";"
                                                                              : " \t";
    const bool is_spaced = *separators == ' ';
    for (std::size_t start = 0; start <= line.size(); ++count) {
      if (is_spaced) start = line.find_first_not_of(separators, start);
      const std::size_t end = std::min(line.find_first_of(separators, start), line.size());
      const std::string_view field = unquoted(trimmed(line.substr(start, end - start)));
      start = end + 1;
      const std::optional<double> number = number_of(field);
      is_header = is_header && !number && !begins_as_number(field);
      if (!number && wrong.data() == nullptr) wrong = field;
      if (number && count < kMostNumbers) numbers[count] = *number;
    }
    if (is_header) return 0;
    if (wrong.data() != nullptr) fail("found " + shown(wrong) + ", expected a number");
    if (count != 6 && count != 7) {
      fail("found " + std::to_string(count) + (count == 1 ? " number" : " numbers") +
           ", expected " + wanted());
    }
    return count;
  }

  std::unique_ptr<Bytes> bytes_;
  std::size_t line_ = 0;
  bool past_header_ = false;
};

class RayTableReader::NpySource : public RayTableReader::Source {
 public:
  /// Reads the header: two bytes of version, the header's length, and a Python dictionary.
  explicit NpySource(std::unique_ptr<Bytes> bytes) : bytes_(std::move(bytes)) {
    const std::string_view start = bytes_->peek(12);
    if (start.size() < 12) damaged();
    const auto byte = [&](std::size_t i) {
      return std::size_t{static_cast<unsigned char>(start[i])};
    };
    const std::size_t version = byte(6), begin = version == 1 ? 10 : 12;
    std::size_t length = byte(8) | byte(9) << 8;
    if (version != 1) length |= byte(10) << 16 | byte(11) << 24;
    if (version < 1 || version > 3) damaged();
    if (begin + length > Bytes::kMost) damaged();
    const std::string_view text = bytes_->peek(begin + length);
    if (text.size() < begin + length) damaged();
    understand(text.substr(begin, length));
    bytes_->skip(begin + length);
  }

  int next(double (&numbers)[kMostNumbers]) override {
    const std::size_t size = (is_double_ ? 8 : 4) * static_cast<std::size_t>(columns_);
    const std::string_view bytes = bytes_->peek(size);
    if (row_ == rows_) {
      if (!bytes.empty()) {
        throw InputError(bytes_->name() + ": found more bytes after its " + std::to_string(rows_) +
                         " rows, expected the end");
      }
      return 0;
    }
    if (bytes.size() < size) {
      throw InputError(bytes_->name() + ": found the end in row " + std::to_string(row_) +
                       ", expected " + std::to_string(rows_) + " rows");
    }
    for (int i = 0; i < columns_; ++i) numbers[i] = element(bytes, i);
    bytes_->skip(size);
    ++row_;
    return columns_;
  }

  [[noreturn]] void fail(const std::string& what) const override {
    throw InputError(bytes_->name() + ": row " + std::to_string(row_ - 1) + ": " + what);
  }

 private:
  [[noreturn]] void damaged() const {
    throw InputError(bytes_->name() + ": found a damaged header, expected one of a NumPy array");
  }

  [[nodiscard]] double element(std::string_view bytes, int i) const {
    const std::size_t size = is_double_ ? 8 : 4, start = static_cast<std::size_t>(i) * size;
    std::uint64_t word = 0;
    for (std::size_t b = 0; b < size; ++b) {
      word |= std::uint64_t{static_cast<unsigned char>(bytes[start + b])} << (8 * b);
    }
    if (is_double_) return std::bit_cast<double>(word);
    return double{std::bit_cast<float>(static_cast<std::uint32_t>(word))};
  }

  /// Returns the text after 'key': in the header, a Python dictionary.
  std::string_view value_of(std::string_view header, std::string_view key) const {
    std::string quoted = "'";
    quoted += key;
    quoted += '\'';
    std::size_t at = header.find(quoted);
    if (at == std::string_view::npos) damaged();
    at = header.find(':', at + quoted.size());
    if (at == std::string_view::npos) damaged();
    return trimmed(header.substr(at + 1));
  }

  void understand(std::string_view header) {
    std::string_view type = value_of(header, "descr");
    type = type.substr(0, type.find(','));
    if (type.size() > 1 && type.front() == '\'' && type.back() == '\'') {
      type = type.substr(1, type.size() - 2);
    }
    is_double_ = type == "<f8";
    if (!is_double_ && type != "<f4") {
      throw InputError(bytes_->name() + ": found elements of type " + shown(type) +
                       ", expected '<f4' or '<f8' (float32 or float64)");
    }
    std::string_view shape = value_of(header, "shape");
    shape = shape.substr(0, shape.find(')') + 1);
    const bool has_order = value_of(header, "fortran_order").starts_with("False");
    const char* const end = shape.data() + shape.size();
    const auto rows =
        std::from_chars(shape.data() + std::min<std::size_t>(1, shape.size()), end, rows_);
    const char* next = rows.ptr;
    while (next != end && (*next == ',' || *next == ' ')) ++next;
    const auto columns = std::from_chars(next, end, columns_);
    if (!shape.starts_with('(') || rows.ec != std::errc() || columns.ec != std::errc() ||
        std::string_view(columns.ptr, static_cast<std::size_t>(end - columns.ptr)) != ")" ||
        (columns_ != 6 && columns_ != 7)) {
      throw InputError(bytes_->name() + ": found an array of shape " + shown(shape) +
                       ", expected (N, 6) or (N, 7): " + kWanted);
    }
    if (!has_order) {
      throw InputError(bytes_->name() + ": found Fortran order, expected C order");
    }
  }

  std::unique_ptr<Bytes> bytes_;
  bool is_double_ = false;
  std::uint64_t rows_ = 0, row_ = 0;
  int columns_ = 0;
};

RayTableReader::RayTableReader(const std::filesystem::path& file, const glm::dvec3& scene_origin)
    : scene_origin_(scene_origin) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  auto bytes = std::make_unique<Bytes>(file);
  if (bytes->peek(kMagic.size()).starts_with(kMagic)) {
    source_ = std::make_unique<NpySource>(std::move(bytes));
  } else if (file.extension() == ".npy") {
    throw InputError(file.string() + ": not a NumPy array: it does not begin as one");
  } else {
    source_ = std::make_unique<CsvSource>(std::move(bytes));
  }
}

RayTableReader::~RayTableReader() = default;

bool RayTableReader::read(std::size_t most, RayTable& block) {
  block.clear(number_);
  double numbers[kMostNumbers];
  while (block.rays.size() < most) {
    const int count = source_->next(numbers);
    if (count == 0) break;
    const char* const wrong =
        block.add({numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]},
                  count > 6 ? numbers[6] : std::numeric_limits<double>::infinity(), scene_origin_);
    if (wrong != nullptr) source_->fail(wrong);
  }
  number_ += block.rays.size();
  return !block.rays.empty();
}

}  // namespace raygate
