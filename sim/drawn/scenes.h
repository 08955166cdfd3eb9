// The scenes behind sim/drawn/drawn.h, one a file. Each fills a canvas; its parameters are those of DrawScene.
#pragma once

#include <cstdint>
#include <string_view>

#include "noise/hash.h"
#include "sim/drawn/canvas.h"

namespace shimmer::sim {

void DrawChart(Canvas& canvas, double scale, uint64_t variation);
void DrawBricks(Canvas& canvas, double scale, uint64_t variation);
void DrawText(Canvas& canvas, double scale, uint64_t variation);
void DrawStar(Canvas& canvas, double scale, uint64_t variation);
void DrawStripes(Canvas& canvas, double scale, uint64_t variation);

// A detail of a variation, in [0, 1): a hash of (variation, what, which).
inline double Detail(uint64_t variation, std::string_view what, uint64_t which = 0) {
  return noise::UnitFromBits(noise::HashPath(variation, which, what));
}

}  // namespace shimmer::sim
