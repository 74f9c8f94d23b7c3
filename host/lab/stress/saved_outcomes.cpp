#include "host/lab/stress/saved_outcomes.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "host/film/pending_file.h"
#include "host/lab/stress/tally_json.h"
#include "host/scene/io/input_error.h"

namespace raygate::stress {
namespace {

using nlohmann::ordered_json;

/// FNV-1a of the executable.
std::uint64_t program_digest() {
  std::ifstream program("/proc/self/exe", std::ios::binary);
  std::uint64_t digest = 14695981039346656037u;
  for (auto i = std::istreambuf_iterator<char>(program); i != std::istreambuf_iterator<char>();
       ++i) {
    digest = (digest ^ static_cast<unsigned char>(*i)) * 1099511628211u;
  }
  return digest;
}

}  // namespace

SavedOutcomes::SavedOutcomes(std::filesystem::path folder, const RunOptions& options,
                             const std::vector<VariantKind>& variants)
    : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw InputError(folder_.string() + ": cannot make the folder: " + error.message());
  ordered_json names = ordered_json::array();
  for (const VariantKind& variant : variants) names.push_back(variant.name);
  run_ = ordered_json{{"program", program_digest()},
                      {"tests", options.tests},
                      {"seed", options.seed},
                      {"variants", names}}
             .dump();
}

std::filesystem::path SavedOutcomes::file_of(const Suite& suite) const {
  std::string name = suite.name;
  std::ranges::replace(name, ' ', '-');
  return folder_ / ("suite-" + name + ".json");
}

std::optional<SuiteOutcome> SavedOutcomes::load(const Suite& suite) const {
  std::ifstream file(file_of(suite));
  if (!file) return std::nullopt;
  try {
    const auto json = ordered_json::parse(file);
    if (json.at("run").dump() != run_) return std::nullopt;
    SuiteOutcome outcome;
    outcome.suite = &suite;
    for (const auto& tally : json.at("tallies")) outcome.tallies.push_back(tally_from(tally));
    outcome.broken_claims = json.at("broken_claims");
    outcome.seconds = json.at("seconds");
    return outcome;
  } catch (const std::exception&) {  // not one of ours, or damaged: the suite is run again
    return std::nullopt;
  }
}

void SavedOutcomes::save(const SuiteOutcome& outcome) const {
  ordered_json tallies = ordered_json::array();
  for (const Tally& tally : outcome.tallies) tallies.push_back(whole(tally));
  const ordered_json json = {{"run", ordered_json::parse(run_)},
                             {"broken_claims", outcome.broken_claims},
                             {"seconds", outcome.seconds},
                             {"tallies", tallies}};
  PendingFile(file_of(*outcome.suite), json.dump() + "\n").commit();
}

}  // namespace raygate::stress
