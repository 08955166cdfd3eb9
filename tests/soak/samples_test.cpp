// Fault 6: samples that are no light, or much of it, in the sources.
#include <cmath>
#include <limits>

#include "tests/soak/faulty_run.h"
#include "tests/soak/soak.h"

namespace shimmer::app {
namespace {

using Limits = std::numeric_limits<float>;

const cv::Size kSize(96, 64);
const cv::Point kPlace(48, 32);

struct Sample {
  const char* name;
  float value;
  bool replaced;  // by what docs/model.md says: a half float's largest, or black
};

class Samples : public testing::TestWithParam<Sample> {
 protected:
  static cv::Mat Grey() { return cv::Mat(kSize, CV_32FC3, cv::Scalar::all(0.5)); }

  // The set of one picture, as it comes out in a format.
  dataset::DatasetReader SetOf(const cv::Mat& picture, const std::string& name, const std::string& format,
                               int bits) {
    PutWithOiio(folder_, name + ".exr", picture, OIIO::TypeFloat);
    folder_.Put(
        "c.json",
        SmallConfig({{"clips", 1},
                     {"size", {kSize.width, kSize.height}},
                     {"source", {{"images", name + ".exr"}}},
                     {"output", {{"format", format}, {"bits", bits}, {"truth", {"tilt", "sigma"}}}}}));
    const std::string set = name + "_" + format + std::to_string(bits);
    ExpectDone(Shimmer(folder_, GenerateWords("c.json", set)));
    return dataset::DatasetReader(folder_ / set);
  }

  void ExpectReplaced(const dataset::DatasetReader& set, int64_t samples) {
    EXPECT_EQ(set.Line(0).at("source").value("replaced_samples", int64_t{0}),
              GetParam().replaced ? samples : 0);
    for (int64_t frame = 0; frame < 2; ++frame) {
      EXPECT_EQ(set.Turb(0, frame).replaced + set.Clean(0, frame).replaced, 0);  // reading replaces too
      EXPECT_TRUE(cv::checkRange(set.Turb(0, frame).pixels, true, nullptr, -65505, 65505));
      EXPECT_TRUE(cv::checkRange(set.TruthTilt(0, frame).value()));
      EXPECT_TRUE(cv::checkRange(set.TruthSigma(0, frame).value()));
    }
  }

  TempFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Values, Samples,
                         testing::Values(Sample{"NaN", Limits::quiet_NaN(), true},
                                         Sample{"Inf", Limits::infinity(), true},
                                         Sample{"MinusInf", -Limits::infinity(), true},
                                         Sample{"Huge", 1e38f, true}, Sample{"MinusHuge", -1e38f, true},
                                         Sample{"TooLarge", 65505, true}, Sample{"Largest", 65504, false},
                                         Sample{"Negative", -0.5f, false},
                                         Sample{"Denormal", Limits::denorm_min(), false}),
                         [](const auto& info) { return info.param.name; });

struct Format {
  const char* name;
  int bits;
};
constexpr Format kFormats[] = {{"png", 8}, {"png", 16}, {"exr", 16}, {"exr", 32}};

// What one pixel holds is seen no farther than a frame's surroundings reach.
TEST_P(Samples, OfOnePixelChangeItsNeighboursAlone) {
  cv::Mat picture = Grey();
  picture.at<cv::Vec3f>(kPlace) = cv::Vec3f::all(GetParam().value);
  for (const auto [format, bits] : kFormats) {
    const auto with = SetOf(picture, "pixel", format, bits), without = SetOf(Grey(), "grey", format, bits);
    ExpectReplaced(with, 3);
    const int reach_px = with.Line(0).at("plan").at("halo_px");
    ASSERT_LT(2 * reach_px, kSize.height);
    cv::Mat far(kSize, CV_8U, cv::Scalar(255));
    far(cv::Rect(kPlace - cv::Point(reach_px, reach_px), cv::Size(2 * reach_px + 1, 2 * reach_px + 1))) = 0;
    // Sums that run along a row keep a float's rounding of what has passed through them.
    const double rounding = format == std::string("png") ? 0 : 1e-7 * 65504;
    for (int64_t frame = 0; frame < 2; ++frame)
      EXPECT_LE(cv::norm(with.Turb(0, frame).pixels, without.Turb(0, frame).pixels, cv::NORM_INF, far),
                rounding)
          << format << bits;
  }
}

TEST_P(Samples, OfAWholeFrameGiveAFrame) {
  const cv::Mat picture(kSize, CV_32FC3, cv::Scalar::all(GetParam().value));
  for (const auto [format, bits] : kFormats)
    ExpectReplaced(SetOf(picture, "frame", format, bits), int64_t{3} * kSize.area());
}

}  // namespace
}  // namespace shimmer::app
