#include "noise/planned_octaves.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "noise/spline_rows.h"

namespace shimmer::noise {
namespace {

int64_t FloorMod(int64_t a, int64_t n) { return (a % n + n) % n; }

const std::vector<Octave>& ListOf(const PlannedOctaves::Octaves& octaves) {
  return std::visit([](const auto& o) -> const std::vector<Octave>& { return o.octaves(); }, octaves);
}

bool Fits(const Octave& octave, const OctaveWay& way) {
  if (way.kind == OctaveWayKind::kTiled) return PeriodPx(octave.step_px) == way.period_px;
  const bool power_of_two =
      way.spacing_px > 0 && way.spacing_px <= kWidestSpacing && (way.spacing_px & (way.spacing_px - 1)) == 0;
  return power_of_two && way.key_frames > 0;
}

void CopyRow(const float* row, std::span<float> out) { std::copy_n(row, out.size(), out.begin()); }

// Weights of the cubic through keys -1, 0, 1, 2 at t in [0, 1).
std::array<float, 4> CubicWeights(double t) {
  return {static_cast<float>(-t * (t - 1) * (t - 2) / 6), static_cast<float>((t + 1) * (t - 1) * (t - 2) / 2),
          static_cast<float>(-(t + 1) * t * (t - 2) / 2), static_cast<float>((t + 1) * t * (t - 1) / 6)};
}

}  // namespace

PlannedOctaves::PlannedOctaves(Octaves octaves, FieldPlan plan, const PixelArea& area)
    : octaves_(std::move(octaves)), plan_(std::move(plan)), area_(area) {
  const std::vector<Octave>& list = ListOf(octaves_);
  if (!std::ranges::equal(list, plan_.octaves, Fits))
    throw std::invalid_argument("plan of " + std::to_string(plan_.octaves.size()) +
                                " octaves, must be made for the same " + std::to_string(list.size()));
  if (area.width < 1 || area.height < 1)
    throw std::invalid_argument("area of " + std::to_string(area.width) + "x" + std::to_string(area.height) +
                                " px, must be at least 1x1");
  for (size_t i = 0; i < plan_.octaves.size(); ++i) {
    const OctaveWay& way = plan_.octaves[i];
    if (way.kind != OctaveWayKind::kGrid) continue;
    auto layer = std::ranges::find_if(layers_, [&](const Layer& l) {
      return l.spacing_px == way.spacing_px && l.key_frames == way.key_frames;
    });
    if (layer == layers_.end())
      layer = layers_.insert(layer, Layer{way.spacing_px,
                                          way.key_frames,
                                          {},
                                          way.key_frames > 1 ? std::make_unique<KeyGrids>() : nullptr});
    layer->octaves.push_back(i);
  }
  for (size_t i = plan_.octaves.size(); i-- > 0;) {
    const OctaveWay& way = plan_.octaves[i];
    if (way.kind == OctaveWayKind::kTiled && others_.empty() &&
        (one_tile_.empty() || way.period_px % plan_.octaves[one_tile_.back()].period_px == 0))
      one_tile_.push_back(i);
    else if (way.kind == OctaveWayKind::kTiled || way.kind == OctaveWayKind::kFull)
      others_.push_back(i);
  }
  std::ranges::stable_sort(layers_, std::greater<>(), &Layer::spacing_px);
}

void PlannedOctaves::AddOctave(size_t i, int64_t t, int64_t y, int64_t x0, int64_t spacing_px,
                               std::span<float> out) const {
  std::visit([&](const auto& octaves) { octaves.AddOctave(i, t, y, x0, spacing_px, out); }, octaves_);
}

Grid PlannedOctaves::Evaluate(const Layer& layer, const PixelArea& points, int64_t t) const {
  const auto add_octaves = [&](int64_t y, int64_t x0, std::span<float> row) {
    for (const size_t i : layer.octaves) AddOctave(i, t, y, x0, layer.spacing_px, row);
  };
  Grid grid = spare_->Take(points);
  if (layer.spacing_px > 1) {
    FilterSpline(add_octaves, grid);
    return grid;
  }
  std::ranges::fill(grid.values, 0.0f);
  for (int64_t y = points.y0; y < points.y0 + points.height; ++y) add_octaves(y, points.x0, grid.Row(y));
  return grid;
}

Grid PlannedOctaves::Between(const Layer& layer, const PixelArea& points, int64_t t) const {
  if (layer.key_frames == 1) return Evaluate(layer, points, t);
  const int64_t after = FloorMod(t, layer.key_frames), key = (t - after) / layer.key_frames;
  std::array<std::shared_ptr<const Grid>, 4> grids;
  Rows<4> rows;
  for (int k = 0; k < 4; ++k) {
    grids[k] = layer.keys->At(key + k - 1,
                              [&] { return Evaluate(layer, points, (key + k - 1) * layer.key_frames); });
    rows[k] = grids[k]->values.data();
  }
  Grid mixed = spare_->Take(points);
  MixRows(CubicWeights(static_cast<double>(after) / layer.key_frames), rows, mixed.values);
  return mixed;
}

// The sum of all grids but those of single pixels: from the coarsest to that of 2 px, each refined into the
// next.
Grid PlannedOctaves::Spline(int64_t t) const {
  std::vector<PixelArea> areas{SplineAreaOf(area_)};
  const int coarsest = layers_.front().spacing_px;
  for (int spacing = 2; spacing < coarsest; spacing *= 2) areas.push_back(CoarserAreaOf(areas.back()));
  std::optional<Grid> sum;
  auto layer = layers_.begin();
  for (int spacing = coarsest; spacing > 1; spacing /= 2, areas.pop_back()) {
    std::optional<Grid> coarser = std::move(sum);
    sum.reset();
    for (; layer != layers_.end() && layer->spacing_px == spacing; ++layer) {
      Grid grid = Between(*layer, areas.back(), t);
      if (sum) {
        AddRow(grid.values.data(), sum->values);
        spare_->Give(std::move(grid));
      } else {
        sum = std::move(grid);
      }
    }
    if (!sum) {
      sum = spare_->Take(areas.back());
      std::ranges::fill(sum->values, 0.0f);
    }
    if (coarser) {
      AddRefined(*coarser, *sum);
      spare_->Give(*std::move(coarser));
    }
  }
  return *std::move(sum);
}

template <class Use>
void PlannedOctaves::Tile::OfRow(int64_t y, int64_t x0, std::span<float> row, const Use& use) const {
  // Row block r of a tile is the first one, moved by r periods
  const PixelArea& area = values.area;
  const int64_t tile_y = (y - area.y0) % period_px, moved = y - area.y0 - tile_y;
  int64_t x = FloorMod(x0 + moved, area.width);
  for (; !row.empty(); x = 0) {
    const auto part = row.first(std::min(row.size(), static_cast<size_t>(area.width - x)));
    use(values.At(area.y0 + tile_y, x), part);
    row = row.subspan(part.size());
  }
}

PlannedOctaves::Tile PlannedOctaves::MakeTile(std::span<const size_t> octaves, int64_t t) const {
  std::optional<Tile> sum;
  for (const size_t i : octaves) {
    const int period = plan_.octaves[i].period_px;
    const int width = std::holds_alternative<SimplexOctaves>(octaves_) ? 3 * period : period;
    const bool same_tile = sum && sum->period_px == period;
    Tile tile = same_tile ? *std::move(sum)
                          : Tile{period, spare_->Take({0, area_.y0, width, std::min(period, area_.height)})};
    for (int64_t y = area_.y0; y < area_.y0 + tile.values.area.height; ++y) {
      const std::span<float> row = tile.values.Row(y);
      if (!sum)
        std::ranges::fill(row, 0.0f);
      else if (!same_tile)
        sum->OfRow(y, 0, row, CopyRow);
      AddOctave(i, t, y, 0, 1, row);
    }
    if (sum && !same_tile) spare_->Give(std::move(sum->values));
    sum = std::move(tile);
  }
  return *std::move(sum);
}

PlannedOctaves::Frame PlannedOctaves::At(int64_t t) const {
  Frame frame(this, t);
  if (!layers_.empty() && layers_.front().spacing_px > 1) frame.spline_.push_back(Spline(t));
  for (const Layer& layer : layers_)
    if (layer.spacing_px == 1) frame.pixels_.push_back(Between(layer, area_, t));
  if (!one_tile_.empty()) frame.tiles_.push_back(MakeTile(one_tile_, t));
  for (const size_t& i : others_)
    if (plan_.octaves[i].kind == OctaveWayKind::kTiled) frame.tiles_.push_back(MakeTile({&i, 1}, t));
  return frame;
}

PlannedOctaves::Frame::~Frame() {
  for (std::vector<Grid>* grids : {&spline_, &pixels_})
    for (Grid& grid : *grids) field_->spare_->Give(std::move(grid));
  for (Tile& tile : tiles_) field_->spare_->Give(std::move(tile.values));
}

void PlannedOctaves::Frame::Row(int64_t y, int64_t x0, std::span<float> out) const {
  const PixelArea& area = field_->area_;
  const auto count = static_cast<int64_t>(out.size());
  if (y < area.y0 || y >= area.y0 + area.height || x0 < area.x0 || x0 + count > area.x0 + area.width)
    throw std::invalid_argument("row " + std::to_string(y) + ", pixels " + std::to_string(x0) + " to " +
                                std::to_string(x0 + count) + ", must lie in the area");
  auto tile = tiles_.begin();
  if (!spline_.empty())
    EvaluateSpline(spline_.front(), y, x0, out);
  else if (!field_->one_tile_.empty())
    (tile++)->OfRow(y, x0, out, CopyRow);
  else
    std::ranges::fill(out, 0.0f);
  for (const Grid& grid : pixels_) AddRow(grid.At(y, x0), out);
  if (!spline_.empty() && !field_->one_tile_.empty()) (tile++)->OfRow(y, x0, out, AddRow);
  for (const size_t i : field_->others_) {
    if (field_->plan_.octaves[i].kind == OctaveWayKind::kFull)
      field_->AddOctave(i, t_, y, x0, 1, out);
    else
      (tile++)->OfRow(y, x0, out, AddRow);
  }
}

}  // namespace shimmer::noise
