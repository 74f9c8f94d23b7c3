#include RAYGATE_MODEL_HEADER
#include "sim/plane_model.h"

RAYGATE_FACTORY raygate::PlaneModel* make_model() {
  return new raygate::PlaneModelOf<RAYGATE_MODEL>;
}
