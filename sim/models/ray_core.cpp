#include RAYGATE_MODEL_HEADER
#include RAYGATE_MODEL_ROOT
#include "sim/core_model.h"

RAYGATE_FACTORY raygate::CoreUnit* make_model(const raygate::MemoryTiming& timing,
                                              const raygate::CoreStalls& stalls,
                                              const raygate::CoreSet& set) {
  return new raygate::CoreModel<RAYGATE_MODEL>(timing, stalls, set);
}
