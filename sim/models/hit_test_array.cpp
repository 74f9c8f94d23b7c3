#include "sim/array_model.h"

#include RAYGATE_MODEL_HEADER
#include RAYGATE_MODEL_ROOT

RAYGATE_FACTORY raygate::BurstModel* make_model(int lanes, const raygate::BurstStalls& stalls) {
  return new raygate::ArrayModel<RAYGATE_MODEL>(lanes, stalls);
}
