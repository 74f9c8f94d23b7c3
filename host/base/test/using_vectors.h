// Selects an instruction set for a part of a test.
#pragma once

#include "host/base/vectors.h"

namespace raygate {

/// Selects an instruction set for the lifetime of the object.
class UsingVectors {
 public:
  explicit UsingVectors(Vectors vectors) : before_(vectors_in_use()) { use_vectors(vectors); }
  UsingVectors(const UsingVectors&) = delete;
  UsingVectors& operator=(const UsingVectors&) = delete;
  ~UsingVectors() { use_vectors(before_); }

 private:
  Vectors before_;
};

}  // namespace raygate
