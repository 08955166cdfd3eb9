// Where in the clean frame each output pixel comes from.
#pragma once

#include <span>

#include "noise/planned_octaves.h"
#include "sim/draw.h"
#include "sim/scene.h"

namespace shimmer::sim {

// The shifts of TiltParams for one clip. Depends on its arguments alone: any order, any thread, same bits.
class TiltField {
 public:
  TiltField(const TiltParams& params, ClipKey key);

  // Writes the shift in px of pixels x0 .. x0 + n - 1 of row y in frame t; n = dx.size() = dy.size().
  void Row(int64_t t, int64_t y, int64_t x0, std::span<float> dx, std::span<float> dy) const {
    x_.Row(t, y, x0, dx);
    y_.Row(t, y, x0, dy);
  }

  // The double twin of one pixel's shift.
  struct Shift {
    double x, y;
  };
  Shift Double(int64_t t, int64_t y, int64_t x) const { return {x_.Double(t, y, x), y_.Double(t, y, x)}; }

  const noise::SimplexOctaves& x() const { return x_; }
  const noise::SimplexOctaves& y() const { return y_; }

 private:
  noise::SimplexOctaves x_, y_;
};

// Both axes of a field over an area of pixels, as a plan says (sim/field_plan.h): their octaves have the same
// steps and amplitudes, so that one plan serves both.
struct PlannedTilt {
  noise::PlannedOctaves x, y;

  PlannedTilt(const TiltField& field, const noise::FieldPlan& plan, const noise::PixelArea& area)
      : x(field.x(), plan, area), y(field.y(), plan, area) {}
};

// The sum of octaves that an axis of the tilt is.
noise::OctaveParams SumOf(const TiltParams& tilt);

// The lattices of a clip's field, as the config's tilt.lattice says. path names the axis, "tilt.x" or "blur".
std::vector<noise::Octave> MakeOctaves(const noise::OctaveParams& params, LatticeKind lattice, ClipKey key,
                                       std::string_view path);

}  // namespace shimmer::sim
