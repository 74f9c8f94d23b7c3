// Replaces the Embree peers and subjects if CMake found no Embree 3.
#include "host/base/input_error.h"
#include "host/lab/rays/rays.h"
#include "host/lab/stress/subjects.h"

namespace raygate::lab {

std::vector<std::unique_ptr<Peer>> make_embrees(const Scene&) { return {}; }
std::vector<std::unique_ptr<Peer>> make_embrees4(const Scene&, const std::string& file) {
  throw InputError(file + ": this lab was built without Embree 3's headers (libembree-dev)");
}
std::vector<SubjectKind> embree_subjects() { return {}; }
std::vector<std::pair<std::string, std::vector<std::uint32_t>>> embree_hit_counts(
    const Scene&, std::span<const Ray>) {
  return {};
}

}  // namespace raygate::lab
