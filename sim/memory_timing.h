// Memory timing: latency and bandwidth of the memory behind a simulated ray core.
#pragma once

#include <cstdint>

namespace raygate {

struct MemoryTiming {
  int latency = 50;        ///< clocks from taking a request to its line, on a cache miss; 1 or more
  int bytes = 64;          ///< bytes per clock: 1, 2, 4 ... 64; one request per 64 / bytes clocks
  int cache_lines = 0;     ///< of a direct-mapped cache in front of the memory; 0 or a power of two
  int cache_latency = 4;   ///< clocks from taking a request to its line, on a cache hit
  int disorder = 0;        ///< maximum of random extra clocks for each line
  int not_taken = 0;       ///< chance per clock, in 1/256, that no request is taken
  std::uint64_t seed = 0;  ///< random seed for disorder and not_taken
};

}  // namespace raygate
