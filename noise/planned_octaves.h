// A sum of octaves over an area of pixels, evaluated as a FieldPlan says (noise/field_plan.h).
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "noise/field_plan.h"
#include "noise/key_grids.h"
#include "noise/octaves.h"
#include "noise/spare_grids.h"

namespace shimmer::noise {

// Every pixel's bits depend on the octaves, the plan, the frame and the pixel alone: any order of frames, any
// thread, any area that holds the pixel.
class PlannedOctaves {
 public:
  using Octaves = std::variant<SimplexOctaves, PerlinOctaves>;

  // plan = PlanOctaves(octaves, ...). Throws std::invalid_argument if the two don't fit.
  PlannedOctaves(Octaves octaves, FieldPlan plan, const PixelArea& area);

  class Frame;
  Frame At(int64_t t) const;  // evaluates the grids and tiles of frame t, on this thread

  const FieldPlan& plan() const { return plan_; }
  const PixelArea& area() const { return area_; }

 private:
  // Octaves that share a grid.
  struct Layer {
    int spacing_px, key_frames;
    std::vector<size_t> octaves;
    std::unique_ptr<KeyGrids> keys;  // if key_frames > 1
  };
  struct Tile {  // a sum of octaves
    int period_px;
    Grid values;  // rows of the area from its first on, until they repeat

    // Calls use(values, part) for the parts of a row of pixels x0 .. that lie in a row of the tile.
    template <class Use>
    void OfRow(int64_t y, int64_t x0, std::span<float> row, const Use& use) const;
  };

  void AddOctave(size_t i, int64_t t, int64_t y, int64_t x0, int64_t spacing_px, std::span<float> out) const;
  Grid Evaluate(const Layer& layer, const PixelArea& points, int64_t t) const;
  Grid Between(const Layer& layer, const PixelArea& points, int64_t t) const;
  Grid Spline(int64_t t) const;
  Tile MakeTile(std::span<const size_t> octaves, int64_t t) const;

  Octaves octaves_;
  FieldPlan plan_;
  PixelArea area_;
  std::vector<Layer> layers_;  // coarsest first
  // Octaves that lie on no grid, as they are summed: from the last to the first, as full evaluation does
  std::vector<size_t> one_tile_;  // tiled ones whose periods divide the next ones': summed in one tile
  std::vector<size_t> others_;    // the rest
  std::unique_ptr<SpareGrids> spare_ = std::make_unique<SpareGrids>();
};

// One frame; keep its PlannedOctaves where it is until then.
class PlannedOctaves::Frame {
 public:
  Frame(Frame&&) = default;
  Frame& operator=(Frame&&) = delete;
  ~Frame();

  // Writes the sum of pixels x0 .. of row y, all in the area. Any thread. Throws std::invalid_argument.
  void Row(int64_t y, int64_t x0, std::span<float> out) const;

 private:
  friend PlannedOctaves;
  Frame(const PlannedOctaves* field, int64_t t) : field_(field), t_(t) {}

  const PlannedOctaves* field_;
  int64_t t_;
  std::vector<Grid> spline_;  // of spacing 2 px; none where no octave lies on a grid
  std::vector<Grid> pixels_;  // of spacing 1 px
  std::vector<Tile> tiles_;   // that of one_tile_, if there is any, and those of others_
};

}  // namespace shimmer::noise
