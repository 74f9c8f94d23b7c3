#include RAYGATE_MODEL_HEADER
#include RAYGATE_MODEL_ROOT
#include "sim/board_link.h"

RAYGATE_FACTORY raygate::WordLink* make_model() { return new raygate::BoardLink<RAYGATE_MODEL>; }
