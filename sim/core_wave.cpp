#include "sim/core_wave.h"

#include "Vray_core_open.h"
#include "sim/core_model.h"
#include "sim/wave_model.h"

namespace raygate {

std::unique_ptr<CoreUnit> make_core_wave(const std::filesystem::path& file,
                                         const MemoryTiming& timing) {
  auto core = std::make_unique<CoreModel<Vray_core_open, WaveModel>>(timing);
  core->model().record(file.string());
  return core;
}

}  // namespace raygate
