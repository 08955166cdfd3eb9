// What a researcher checks: the clean frame, bent and blurred as the truth says, is the turbulent frame, to
// the rounding of the file.
#include <cmath>

#include "sim/dataset/dataset_reader.h"
#include "tests/app/program.h"

namespace shimmer::app {
namespace {

struct Case {
  const char *name, *format;
  int bits;
  const char* colour;

  // Simulated in linear light and encoded for the file.
  bool encoded() const { return colour == std::string("linear") && format == std::string("png"); }
  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

// Catmull-Rom (cubic convolution with a = -1/2) at distance t from a pixel.
double CubicWeight(double t) {
  t = std::abs(t);
  if (t < 1) return (1.5 * t - 2.5) * t * t + 1;
  if (t < 2) return ((-0.5 * t + 2.5) * t - 4) * t + 2;
  return 0;
}

// Channel c of the image at (x, y), all of whose 16 neighbours lie within.
double At(const cv::Mat& image, double x, double y, int c) {
  const int left = static_cast<int>(std::floor(x)) - 1, top = static_cast<int>(std::floor(y)) - 1;
  double sum = 0;
  for (int j = top; j < top + 4; ++j)
    for (int i = left; i < left + 4; ++i)
      sum += CubicWeight(x - i) * CubicWeight(y - j) * image.ptr<float>(j)[i * image.channels() + c];
  return sum;
}

double DecodeSrgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
double EncodeSrgb(double v) {
  v = std::max(v, 0.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

// The step between the samples that a file has around a value.
double StepAt(double value, const Case& c) {
  if (std::string(c.format) == "png") return 1.0 / ((1 << c.bits) - 1);
  const int digits = c.bits == 16 ? 10 : 23, exponent = std::max(std::ilogb(value), -14);
  return std::ldexp(1, exponent - digits);
}

// Channel c, warped as the truth says wherever its 16 neighbours are in the frame; NaN elsewhere.
cv::Mat Warped(const cv::Mat& clean, const cv::Mat& tilt, int c) {
  cv::Mat warped(clean.size(), CV_64F, std::nan(""));
  for (int y = 0; y < clean.rows; ++y)
    for (int x = 0; x < clean.cols; ++x) {
      const cv::Vec2d d = tilt.at<cv::Vec2f>(y, x);
      const double px = x + d[0], py = y + d[1];
      if (px >= 1 && py >= 1 && px < clean.cols - 2 && py < clean.rows - 2)
        warped.at<double>(y, x) = At(clean, px, py, c);
    }
  return warped;
}

// The Gaussian of this sigma around (x, y); NaN where it meets one.
double Blurred(const cv::Mat& warped, int x, int y, double sigma) {
  const int radius = static_cast<int>(std::ceil(6 * sigma));
  std::vector<double> weights;
  for (int k = -radius; k <= radius; ++k)
    weights.push_back(radius == 0 ? 1 : std::exp(-0.5 * k * k / (sigma * sigma)));
  double sum = 0, weight = 0;
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i) {
      const double both = weights[i + radius] * weights[j + radius];
      sum += both * warped.at<double>(y + j, x + i);
      weight += both;
    }
  return sum / weight;
}

// How the turbulent frame differs from what the truth makes of the clean one, over the pixels at least
// border_px within the frame.
struct Difference {
  double worst = -1;  // beyond the rounding to the file's step
  double squares = 0, moved = 0;
  int pixels = 0;
};

void Compare(const dataset::DatasetReader& reader, int64_t frame, const Case& c, int border_px,
             Difference& difference) {
  const cv::Mat stored = reader.Clean(0, frame).pixels, turb = reader.Turb(0, frame).pixels;
  const cv::Mat tilt = reader.TruthTilt(0, frame).value(), sigma = reader.TruthSigma(0, frame).value();
  cv::Mat clean = stored.clone();
  if (c.encoded())
    for (int y = 0; y < clean.rows; ++y)
      for (int i = 0; i < 3 * clean.cols; ++i)
        clean.ptr<float>(y)[i] = static_cast<float>(DecodeSrgb(clean.ptr<float>(y)[i]));
  for (int channel = 0; channel < 3; ++channel) {
    const cv::Mat warped = Warped(clean, tilt, channel);
    for (int y = border_px; y < turb.rows - border_px; ++y)
      for (int x = border_px; x < turb.cols - border_px; ++x, ++difference.pixels) {
        double expected = Blurred(warped, x, y, sigma.at<float>(y, x));
        ASSERT_FALSE(std::isnan(expected)) << x << " " << y;
        if (c.encoded()) expected = EncodeSrgb(expected);
        if (c.format == std::string("png")) expected = std::clamp(expected, 0.0, 1.0);
        const double seen = turb.at<cv::Vec3f>(y, x)[channel], error = std::abs(seen - expected);
        difference.worst = std::max(difference.worst, error - StepAt(expected, c) / 2);
        difference.squares += error * error;
        difference.moved = std::max(difference.moved, std::abs(seen - stored.at<cv::Vec3f>(y, x)[channel]));
      }
  }
}

class Pair : public testing::TestWithParam<Case> {};

TEST_P(Pair, IsConsistent) {
  const Case c = GetParam();
  const TempFolder folder;
  WritePng(folder, "in.png", dataset::RandomImage({150, 120}, 3, 5));  // noise: the hardest picture to bend
  folder.Put(
      "c.json",
      SmallConfig({{"clips", 1},
                   {"size", {72, 60}},
                   {"source", {{"images", "in.png"}}},
                   {"tilt", {{"strength_px", 4}}},
                   {"blur", {{"min_sigma_px", 0.1}, {"max_sigma_px", 1.5}}},
                   {"accuracy", {{"max_error_px", 0}, {"max_error_levels", 0}}},
                   {"colour", c.colour},
                   {"output", {{"format", c.format}, {"bits", c.bits}, {"truth", {"tilt", "sigma"}}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const dataset::DatasetReader reader(folder / "set");
  Difference difference;
  for (const int64_t frame : {0, 1})  // six sigma, strength, and the cubic's reach from the border
    Compare(reader, frame, c, 9 + 4 + 2, difference);
  EXPECT_EQ(difference.pixels, 2 * 3 * 42 * 30);
  EXPECT_GT(difference.moved, 0.2);  // a picture that nothing was done to would not do
  // The program's float32: some ten operations of 6e-8 on values up to 2, times 12.92, the steepest part of
  // the sRGB curve, where that is applied.
  EXPECT_LE(difference.worst, 2e-6 * (c.encoded() ? 12.92 : 1));
}

// What the config allows to be lost is a bound: in 1/255 of the range, RMS over a natural image.
TEST(Program, KeepsItsPromiseOfAccuracy) {
  const fs::path photos = fs::path(SHIMMER_SHARED_DIR) / "data/photos/kodak8";
  if (!fs::exists(photos)) GTEST_SKIP() << photos << " is not on this machine";
  for (const double max_sigma_px : {0.7, 3.0, 6.0}) {
    const TempFolder folder;
    folder.Put("c.json",
               SmallConfig({{"clips", 1},
                            {"frames", 1},
                            {"size", {160, 140}},
                            {"source", {{"images", (photos / "*.png").string()}}},
                            {"tilt", {{"strength_px", 4}}},
                            {"blur", {{"max_sigma_px", max_sigma_px}}},
                            {"output", {{"format", "exr"}, {"bits", 32}, {"truth", {"tilt", "sigma"}}}}}));
    ExpectDone(Generate(folder, "c.json", "set"));
    const dataset::DatasetReader reader(folder / "set");
    Difference difference;
    Compare(reader, 0, {"float", "exr", 32, "stored"}, 36 + 4 + 2, difference);
    const double promised = reader.description().at("/config/accuracy/max_error_levels"_json_pointer);
    EXPECT_LE(255 * std::sqrt(difference.squares / difference.pixels), promised) << max_sigma_px;
  }
}

INSTANTIATE_TEST_SUITE_P(Program, Pair,
                         testing::Values(Case{"png8", "png", 8, "stored"}, Case{"png16", "png", 16, "stored"},
                                         Case{"half", "exr", 16, "stored"},
                                         Case{"float", "exr", 32, "stored"},
                                         Case{"png16_linear", "png", 16, "linear"},
                                         Case{"float_linear", "exr", 32, "linear"}),
                         [](const auto& info) { return info.param.name; });

// The manifest's summary of a clip is that of its truth files.
TEST(Program, SumsUpTheTruth) {
  const TempFolder folder;
  folder.Put("c.json", SmallConfig({{"output", {{"truth", {"tilt", "sigma"}}}}}));
  ExpectDone(Generate(folder, "c.json", "set"));
  const dataset::DatasetReader reader(folder / "set");
  for (const int64_t clip : reader.clips()) {
    double tilt2 = 0, sigma = 0;
    for (int64_t frame = 0; frame < 2; ++frame) {
      tilt2 += std::pow(cv::norm(reader.TruthTilt(clip, frame).value()), 2) / (2 * 24 * 16) / 2;
      sigma += cv::mean(reader.TruthSigma(clip, frame).value())[0] / 2;
    }
    // Sums of 768 doubles from the same floats: they agree to rounding.
    EXPECT_NEAR(reader.Line(clip).at("tilt_rms_px").get<double>(), std::sqrt(tilt2), 1e-6);
    EXPECT_NEAR(reader.Line(clip).at("mean_sigma_px").get<double>(), sigma, 1e-6);
  }
}

}  // namespace
}  // namespace shimmer::app
