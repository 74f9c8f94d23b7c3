#include RAYGATE_MODEL_HEADER
#include "sim/core_model.h"
#include "sim/wave_model.h"

RAYGATE_FACTORY raygate::CoreUnit* make_model(const char* file,
                                              const raygate::MemoryTiming& timing) {
  auto core = std::make_unique<raygate::CoreModel<RAYGATE_MODEL, raygate::WaveModel>>(timing);
  core->model().record(file);
  return core.release();
}
