// Digest of a scene: whether two pictures are of the same one.
#pragma once

#include <string>

#include "host/scene/scene.h"

namespace raygate {

/// 64 bits, as 16 hexadecimal digits, of all that a scene was read to: geometry, materials,
/// textures, lights, instances.
/// Equal scenes have equal digests, on every machine of the same byte order; of two that differ,
/// one pair in 2^64 would. Against mistakes, not against malice: it is no cryptographic hash.
[[nodiscard]] std::string digest_of(const Scene& scene);

}  // namespace raygate
