// Which noise an octave is made of.
#pragma once

#include "noise/simplex.h"

namespace shimmer::noise {

enum class NoiseKind { kSimplex06, kSimplex05, kPerlin };

inline constexpr const SimplexKernel& KernelOf(NoiseKind kind) {  // of a simplex kind
  return kind == NoiseKind::kSimplex06 ? kSimplexKernel06 : kSimplexKernel05;
}

}  // namespace shimmer::noise
