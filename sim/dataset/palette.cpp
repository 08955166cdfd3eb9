#include "sim/dataset/palette.h"

#include <algorithm>
#include <limits>

namespace shimmer::dataset {
namespace {

constexpr int kHistogramBits = 6;  // a channel
constexpr int kNearestBits = 7;
constexpr int kSettlingRounds = 6;
constexpr int kDither_levels =
    8;  // from end to end; about the distance of neighbours in a photograph's palette

struct Colour {
  cv::Vec3d value;  // mean of the pixels
  double pixels;
};

std::vector<Colour> Histogram(std::span<const cv::Mat> frames) {
  constexpr int kShift = 8 - kHistogramBits;
  std::vector<Colour> cells(size_t{1} << 3 * kHistogramBits, Colour{{0, 0, 0}, 0});
  for (const cv::Mat& frame : frames)
    for (int y = 0; y < frame.rows; ++y)
      for (int x = 0; x < frame.cols; ++x) {
        const cv::Vec3b rgb = frame.at<cv::Vec3b>(y, x);
        const int cell =
            (((rgb[0] >> kShift) << kHistogramBits | rgb[1] >> kShift) << kHistogramBits) | rgb[2] >> kShift;
        cells[cell].value += cv::Vec3d(rgb);
        cells[cell].pixels += 1;
      }
  std::erase_if(cells, [](const Colour& cell) { return cell.pixels == 0; });
  for (Colour& cell : cells) cell.value /= cell.pixels;
  return cells;
}

// Colours that share a place in the palette, and what that costs.
struct Box {
  std::span<Colour> colours;
  cv::Vec3d mean{0, 0, 0};
  cv::Vec3d squared_error{0, 0, 0};

  explicit Box(std::span<Colour> members) : colours(members) {
    double pixels = 0;
    for (const Colour& colour : colours) mean += colour.value * colour.pixels, pixels += colour.pixels;
    mean /= pixels;
    for (const Colour& colour : colours) {
      const cv::Vec3d off = colour.value - mean;
      squared_error += off.mul(off) * colour.pixels;
    }
  }
  double Cost() const { return squared_error[0] + squared_error[1] + squared_error[2]; }
};

std::vector<cv::Vec3d> CutIntoBoxes(std::vector<Colour>& colours, size_t most) {
  std::vector<Box> boxes = {Box(colours)};
  while (boxes.size() < most) {
    const auto widest = std::ranges::max_element(boxes, {}, &Box::Cost);
    if (widest->Cost() <= 0) break;
    const auto error = widest->squared_error;
    const int axis = error[0] >= error[1] && error[0] >= error[2] ? 0 : error[1] >= error[2] ? 1 : 2;
    const double cut = widest->mean[axis];
    const std::span<Colour> members = widest->colours;
    const auto above = std::ranges::partition(members, [&](const Colour& c) { return c.value[axis] < cut; });
    const size_t below = members.size() - above.size();
    if (below == 0 || above.empty()) break;
    *widest = Box(members.first(below));
    boxes.push_back(Box(members.subspan(below)));
  }
  std::vector<cv::Vec3d> centres;
  for (const Box& box : boxes) centres.push_back(box.mean);
  return centres;
}

// Lloyd's iteration: each colour to its nearest centre, each centre to the mean of its colours.
void Settle(const std::vector<Colour>& colours, std::vector<cv::Vec3d>& centres) {
  for (int round = 0; round < kSettlingRounds; ++round) {
    std::vector<Colour> sums(centres.size(), Colour{{0, 0, 0}, 0});
    for (const Colour& colour : colours) {
      const auto nearest = std::ranges::min_element(centres, {}, [&](const cv::Vec3d& centre) {
        const cv::Vec3d off = centre - colour.value;
        return off.dot(off);
      });
      Colour& sum = sums[nearest - centres.begin()];
      sum.value += colour.value * colour.pixels;
      sum.pixels += colour.pixels;
    }
    for (size_t i = 0; i < centres.size(); ++i)
      if (sums[i].pixels > 0) centres[i] = sums[i].value / sums[i].pixels;
  }
}

// Bayer's 8 x 8 pattern: 0 to 63, each once.
int Threshold(int x, int y) {
  int value = 0;
  for (int bit = 0; bit < 3; ++bit) {
    const int x_bit = x >> bit & 1, y_bit = y >> bit & 1;
    value = value << 2 | (x_bit ^ y_bit) << 1 | y_bit;
  }
  return value;
}

}  // namespace

Palette ChoosePalette(std::span<const cv::Mat> frames) {
  std::vector<Colour> colours = Histogram(frames);
  std::vector<cv::Vec3d> centres = CutIntoBoxes(colours, Palette().size());
  Settle(colours, centres);
  Palette palette;
  palette.fill(cv::Vec3b(0, 0, 0));
  for (size_t i = 0; i < centres.size(); ++i)
    for (int c = 0; c < 3; ++c) palette[i][c] = cv::saturate_cast<uint8_t>(centres[i][c]);
  return palette;
}

PaletteMapper::PaletteMapper(const Palette& palette)
    : palette_(palette), nearest_(size_t{1} << 3 * kNearestBits, int16_t{-1}) {}

uint8_t PaletteMapper::Nearest(int red, int green, int blue) {
  constexpr int kShift = 8 - kNearestBits;
  int16_t& known =
      nearest_[((red >> kShift) << kNearestBits | green >> kShift) << kNearestBits | blue >> kShift];
  if (known < 0) {
    int best = std::numeric_limits<int>::max();
    for (int i = 0; i < static_cast<int>(palette_.size()); ++i) {
      const int r = palette_[i][0] - red, g = palette_[i][1] - green, b = palette_[i][2] - blue;
      if (const int distance = r * r + g * g + b * b; distance < best)
        best = distance, known = static_cast<int16_t>(i);
    }
  }
  return static_cast<uint8_t>(known);
}

std::vector<uint8_t> PaletteMapper::Map(const cv::Mat& frame) {
  std::vector<uint8_t> places;
  places.reserve(frame.total());
  for (int y = 0; y < frame.rows; ++y)
    for (int x = 0; x < frame.cols; ++x) {
      const cv::Vec3b rgb = frame.at<cv::Vec3b>(y, x);
      const int shift = (Threshold(x, y) * 2 - 63) * kDither_levels / 128;
      places.push_back(Nearest(std::clamp(rgb[0] + shift, 0, 255), std::clamp(rgb[1] + shift, 0, 255),
                               std::clamp(rgb[2] + shift, 0, 255)));
    }
  return places;
}

}  // namespace shimmer::dataset
