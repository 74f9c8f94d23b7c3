#include "host/lab/stress/tally_json.h"

#include <bit>
#include <nlohmann/json.hpp>

#include "host/lab/stress/case_text.h"

namespace raygate::stress {
namespace {

using nlohmann::ordered_json;

template <class Member>
struct Field {
  const char* name;
  Member Tally::*member;
};

constexpr Field<std::uint64_t> kCounts[] = {{"tests", &Tally::tests},
                                            {"rays", &Tally::rays},
                                            {"wrong", &Tally::wrong},
                                            {"ties", &Tally::ties},
                                            {"wrong_ties", &Tally::wrong_ties},
                                            {"leaks", &Tally::leaks},
                                            {"escapes", &Tally::escapes},
                                            {"double_hits", &Tally::double_hits},
                                            {"wrong_nearest", &Tally::wrong_nearest},
                                            {"wrong_tied_nearest", &Tally::wrong_tied_nearest},
                                            {"hits", &Tally::hits},
                                            {"doubts", &Tally::doubts}};
constexpr Field<Errors> kErrors[] = {{"t_ulp", &Tally::t_ulp},
                                     {"t_relative", &Tally::t_relative},
                                     {"point_ulp", &Tally::point_ulp},
                                     {"delivered_t_ulp", &Tally::delivered_t_ulp},
                                     {"delivered_point_ulp", &Tally::delivered_point_ulp}};
constexpr Field<double> kShares[] = {{"t_of_bound", &Tally::t_of_bound},
                                     {"point_of_bound", &Tally::point_of_bound}};

// JSON's decimals know no infinity.
ordered_json bits(double x) { return std::bit_cast<std::uint64_t>(x); }
double from_bits(const ordered_json& json) {
  return std::bit_cast<double>(json.get<std::uint64_t>());
}

ordered_json whole(const Errors& errors) {
  return {{"max", bits(errors.max())}, {"bins", errors.bins()}};
}

Errors errors_from(const ordered_json& json) {
  return {json.at("bins").get<std::map<std::size_t, std::uint64_t>>(), from_bits(json.at("max"))};
}

ordered_json summed_up(const Errors& errors) {
  const Errors::Summary s = errors.summary();
  return {{"count", s.count}, {"median", s.median}, {"p99", s.p99}, {"max", s.max}};
}

}  // namespace

ordered_json whole(const Tally& tally) {
  ordered_json json, angles = ordered_json::array(), failures = ordered_json::array();
  for (const auto& field : kCounts) json[field.name] = tally.*field.member;
  for (const auto& field : kErrors) json[field.name] = whole(tally.*field.member);
  for (const auto& field : kShares) json[field.name] = bits(tally.*field.member);
  for (const Errors& errors : tally.t_ulp_by_angle) angles.push_back(whole(errors));
  for (const Case& failure : tally.failures) failures.push_back(to_text(failure));
  json["t_ulp_by_angle"] = angles;
  json["failures"] = failures;
  return json;
}

Tally tally_from(const ordered_json& json) {
  Tally tally;
  for (const auto& field : kCounts) tally.*field.member = json.at(field.name);
  for (const auto& field : kErrors) tally.*field.member = errors_from(json.at(field.name));
  for (const auto& field : kShares) tally.*field.member = from_bits(json.at(field.name));
  const auto& angles = json.at("t_ulp_by_angle");
  for (int k = 0; k < Tally::kDecades; ++k) tally.t_ulp_by_angle[k] = errors_from(angles.at(k));
  for (const auto& failure : json.at("failures")) {
    tally.failures.push_back(case_from(failure.get<std::string>()));
  }
  return tally;
}

ordered_json summed_up(const Tally& tally) {
  ordered_json json, angles = ordered_json::array(), failures = ordered_json::array();
  for (const auto& field : kCounts) json[field.name] = tally.*field.member;
  for (const auto& field : kErrors) json[field.name] = summed_up(tally.*field.member);
  for (const auto& field : kShares) json[field.name] = tally.*field.member;
  for (const Errors& errors : tally.t_ulp_by_angle) angles.push_back(summed_up(errors));
  for (const Case& failure : tally.failures) failures.push_back(to_text(failure));
  json["t_ulp_by_angle"] = angles;
  json["failures"] = failures;
  return json;
}

}  // namespace raygate::stress
