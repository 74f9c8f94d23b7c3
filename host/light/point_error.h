// Whose point of a hit is shaded: the unit's or the host's.
#pragma once

namespace raygate {

/// How far off, of itself, the unit's P may be before the host computes the point, where nobody
/// says otherwise: rays that meet a surface at a flat angle are the host's.
inline constexpr float kPointError = 0x1p-16f;

}  // namespace raygate
