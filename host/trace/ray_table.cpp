#include "host/trace/ray_table.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <iostream>
#include <iterator>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "host/base/input.h"
#include "host/base/input_error.h"
#include "host/scene/io/text.h"

namespace raygate {

void RayTable::clear(std::uint64_t its_first) {
  first = its_first;
  rays.clear();
  exact_rays.clear();
  limits.clear();
  exponents.clear();
  rounded = rounded_to_floats_ = 0;
}

const char* RayTable::add(const glm::dvec3& origin, const glm::dvec3& direction, double limit,
                          const glm::dvec3& scene_origin) {
  if (!is_finite(origin) || !is_finite(direction)) {
    return "found inf or nan in origin or direction, expected finite numbers";
  }
  if (!(limit > 0.0)) return "found a limit that is not above 0, expected one, or inf";
  if (largest(origin - scene_origin) > kMostCoordinate) {
    return "found an origin farther than 2^126 from the scene, expected a nearer one";
  }
  // As in scaled_direction(): a component that rounds to 2 is scaled to 1.
  const double size = largest(direction);
  int exponent = size == 0.0 ? 0 : -std::ilogb(size);
  if (static_cast<float>(std::ldexp(size, exponent)) == 2.0f) --exponent;
  ExactRay exact;
  bool is_changed = false;
  for (int k = 0; k < 3; ++k) {
    const double start = origin[k] - scene_origin[k];
    exact.origin[k] = on_float_grid(start);
    exact.direction[k] = on_float_grid(std::ldexp(direction[k], exponent));
    is_changed |= !has_exact_difference(origin[k], scene_origin[k]) || exact.origin[k] != start ||
                  std::ldexp(exact.direction[k], -exponent) != direction[k];
  }
  const bool are_floats = is_binary32(exact.origin) && is_binary32(exact.direction);
  rounded += is_changed ? 1 : 0;
  rounded_to_floats_ += is_changed || !are_floats ? 1 : 0;
  if (!are_floats && exact_rays.empty()) exact_rays.assign(rays.begin(), rays.end());
  if (!are_floats || !exact_rays.empty()) exact_rays.push_back(exact);
  rays.push_back({glm::vec3(exact.origin), glm::vec3(exact.direction)});
  limits.push_back(std::max(std::ldexp(limit, -exponent), 0x1p-149));
  exponents.push_back(exponent);
  return nullptr;
}

namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20;  // maximum length of a line
constexpr const char* kWanted = "expected OX,OY,OZ,DX,DY,DZ or OX,OY,OZ,DX,DY,DZ,LIMIT";
constexpr std::string_view kNames[] = {"ox", "oy", "oz", "dx", "dy", "dz", "limit"};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of(" \t\r"), text.size());
  return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

std::string_view unquoted(std::string_view text) {
  const bool is_quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
                         text.back() == text.front();
  return is_quoted ? trimmed(text.substr(1, text.size() - 2)) : text;
}

}  // namespace

RayTableReader::RayTableReader(const std::filesystem::path& file, const glm::dvec3& scene_origin)
    : name_(file == "-" ? "standard input" : file.string()),
      scene_origin_(scene_origin),
      stream_(file == "-" ? std::cin : file_),
      text_(kMostBytes) {
  if (file == "-") {
    std::ios::sync_with_stdio(false);  // makes std::cin buffered
  } else {
    file_.open(file, std::ios::binary);
    if (!file_.is_open()) fail_reading();
  }
  const int first = stream_.peek();
  if (stream_.bad()) fail_reading();
  if (first == 0xFF || first == 0xFE) {
    throw InputError(name_ + ": found UTF-16 text, expected ASCII or UTF-8");
  }
  if (first == 0xEF) stream_.ignore(3);  // UTF-8's byte order mark
}

void RayTableReader::fail_reading() const {
  throw InputError(name_ + ": cannot read: " + std::generic_category().message(errno));
}

void RayTableReader::fail(const std::string& what) const { throw InputError(name_, line_, what); }

int RayTableReader::next(double (&numbers)[kMostNumbers]) {
  while (true) {
    stream_.getline(text_.data(), std::ssize(text_));
    auto size = static_cast<std::size_t>(stream_.gcount());
    if (stream_.bad()) fail_reading();
    if (size == 0) return 0;
    ++line_;
    if (stream_.fail()) fail(std::string("found a line of over 1,000,000 bytes, ") + kWanted);
    if (!stream_.eof()) --size;  // the line's end
    const std::string_view line = trimmed({text_.data(), size});
    if (line.empty() || line.front() == '#') continue;
    if (const int count = split(line, numbers)) return count;
  }
}

int RayTableReader::split(std::string_view line, double (&numbers)[kMostNumbers]) {
  std::string_view wrong;
  std::string misplaced;  // a known name that is not where kWanted has it
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
    const std::optional<double> number = to_number(field);
    is_header = is_header && !number && !field.empty() && field.find_first_of("0123456789+-.") != 0;
    if (!number && wrong.data() == nullptr) wrong = field;
    if (is_header && misplaced.empty()) {
      const auto at = std::ranges::find(kNames, in_lower_case(std::string(field))) - kNames;
      if (at != std::ssize(kNames) && at != count) {
        misplaced = in_quotes(field) + " in column " + std::to_string(count + 1) + ", ";
      }
    }
    if (number && count < kMostNumbers) numbers[count] = *number;
  }
  if (is_header && !misplaced.empty()) fail("found " + misplaced + kWanted);
  if (is_header) return 0;
  if (wrong.data() != nullptr) fail("found " + in_quotes(wrong) + ", expected a number");
  if (count != 6 && count != 7) {
    fail("found " + std::to_string(count) + (count == 1 ? " number, " : " numbers, ") + kWanted);
  }
  return count;
}

bool RayTableReader::read(std::size_t most, RayTable& block) {
  block.clear(number_);
  double numbers[kMostNumbers];
  while (block.rays.size() < most) {
    const int count = next(numbers);
    if (count == 0) break;
    const char* const wrong =
        block.add({numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]},
                  count > 6 ? numbers[6] : std::numeric_limits<double>::infinity(), scene_origin_);
    if (wrong != nullptr) fail(wrong);
  }
  number_ += block.rays.size();
  return !block.rays.empty();
}

}  // namespace raygate
