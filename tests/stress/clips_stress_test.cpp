// Whole frames at the ends of their ranges.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "noise/simplex_double.h"
#include "sim/clip.h"
#include "tests/stress/random_clip.h"

namespace shimmer::sim {
namespace {

// Noise of every kind of sample; floats reach beyond [0, 1].
cv::Mat RandomPicture(cv::Size size, int type, noise::HashStream& stream) {
  cv::Mat picture(size, type);
  for (int y = 0; y < size.height; ++y)
    for (int i = 0; i < size.width * picture.channels(); ++i) {
      const uint64_t bits = stream.Next();
      switch (picture.depth()) {
        case CV_8U:
          picture.ptr<uint8_t>(y)[i] = static_cast<uint8_t>(bits);
          break;
        case CV_16U:
          picture.ptr<uint16_t>(y)[i] = static_cast<uint16_t>(bits);
          break;
        default:
          picture.ptr<float>(y)[i] = static_cast<float>(3 * noise::UnitFromBits(bits) - 1);
      }
    }
  return picture;
}

void ExpectWithin(const cv::Mat& map, double least, double most, uint64_t number) {
  EXPECT_TRUE(cv::checkRange(map)) << number;  // finite
  double lowest, highest;
  cv::minMaxLoc(map.reshape(1), &lowest, &highest);
  EXPECT_GE(lowest, least) << number;
  EXPECT_LE(highest, most) << number;
}

// Whatever a float frame shows lies within what its source shows, but for what bicubic weights (1.5625 in two
// dimensions) and mixtures of levels may over- and undershoot.
void ExpectBounded(const cv::Mat& turb, double least, double most, uint64_t number) {
  const double over = most - least;
  ExpectWithin(turb, least - over, most + over, number);
}

// Within 1e-6 cell of a simplex face a pixel may fall to either side.
bool OnFace(const noise::SimplexOctaves& axis, int64_t t, int y, int x) {
  for (const noise::Octave& o : axis.octaves())
    if (noise::SimplexFaceDistance((o.origin[0] + o.step_px * x).Reduced().ToDouble(),
                                   (o.origin[1] + o.step_px * y).Reduced().ToDouble(),
                                   (o.origin[2] + o.step_frame * t).Reduced().ToDouble()) < 1e-6)
      return true;
  return false;
}

// The corners' shifts against the double twin: what the plan promises, and float32's own 1.5e-5 of S.
void ExpectWithinPromise(const RandomClip& clip, const TiltPlan& plan, const TiltField& field, int64_t t,
                         const cv::Mat& tilt, uint64_t number) {
  const double bound_px = plan.field.max_error + 1.5e-5 * clip.scene.tilt.strength_px;
  EXPECT_LE(plan.field.max_error, clip.accuracy.max_error_px) << number;
  const int64_t time = plan.frozen ? 0 : t;
  for (const int y : {0, tilt.rows - 1})
    for (const int x : {0, tilt.cols - 1}) {
      const auto truth = field.Double(time, y, x);
      const auto shift = tilt.at<cv::Vec2f>(y, x);
      EXPECT_TRUE(std::abs(shift[0] - truth.x) <= bound_px || OnFace(field.x(), time, y, x)) << number;
      EXPECT_TRUE(std::abs(shift[1] - truth.y) <= bound_px || OnFace(field.y(), time, y, x)) << number;
    }
}

void RenderAndCheck(uint64_t number) {
  const RandomClip clip = DrawClip(number, 24);
  noise::HashStream stream(noise::HashPath(0, number, "picture"));
  constexpr int kTypes[] = {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3, CV_32FC1, CV_32FC3};
  const int type = kTypes[stream.Below(6)];
  const ClipPlan plan = PlanClip(clip.scene, clip.shape, clip.accuracy);
  const cv::Size with_halo(clip.shape.size.width + 2 * plan.halo_px,
                           clip.shape.size.height + 2 * plan.halo_px);
  const ClipRenderer renderer(clip.scene, plan, clip.key);
  const int64_t t =
      clip.shape.first_frame + static_cast<int64_t>(stream.Below(static_cast<uint64_t>(clip.shape.frames)));
  const RenderedFrame frame = renderer.Render(t, RandomPicture(with_halo, type, stream));

  ASSERT_EQ(frame.turb.size(), clip.shape.size) << number;
  ASSERT_EQ(frame.turb.type(), type) << number;
  if (frame.turb.depth() == CV_32F) ExpectBounded(frame.turb, -1, 2, number);
  const double bound_px = clip.scene.tilt.BoundPx() + 1e-4;
  ExpectWithin(frame.truth->tilt, -bound_px, bound_px, number);
  const double least_px = plan.blur ? clip.scene.blur.min_sigma_px * (1 - 1e-6) : 0,
               most_px = plan.blur ? clip.scene.blur.max_sigma_px * (1 + 1e-6) : 0;
  ExpectWithin(frame.truth->sigma, least_px, most_px, number);
  if (plan.tilt)
    ExpectWithinPromise(clip, *plan.tilt, *renderer.fields().tilt(), t, frame.truth->tilt, number);
}

TEST(ClipsStress, TenThousandRandomConfigsAreFiniteAndBounded) {
  for (uint64_t number = 0; number < 10000; ++number) RenderAndCheck(number);
}

TEST(ClipsStress, OddShapes) {
  for (const cv::Size size :
       {cv::Size(1, 1), cv::Size(1, 17), cv::Size(17, 1), cv::Size(16384, 3), cv::Size(3, 16384)})
    for (const BlurMethod method : {BlurMethod::kAuto, BlurMethod::kExact, BlurMethod::kStack}) {
      Scene scene;
      scene.blur.method = method;
      scene.blur.max_sigma_px = method == BlurMethod::kAuto ? 32 : 1;  // exact at 32 px takes minutes
      const ClipPlan plan = PlanClip(scene, {.size = size}, {});
      noise::HashStream stream(1);
      const cv::Size with_halo(size.width + 2 * plan.halo_px, size.height + 2 * plan.halo_px);
      const RenderedFrame frame =
          ClipRenderer(scene, plan, {0, 0}).Render(0, RandomPicture(with_halo, CV_32FC1, stream));
      ExpectBounded(frame.turb, -1, 2, 0);
    }
}

TEST(ClipsStress, SigmasAndStrengthsAtTheirEnds) {
  for (const double sigma_px : {0.0, 1e-12, 0.3, 32.0})
    for (const double strength_px : {0.0, 1e-6, 64.0})
      for (const double max_error_levels : {0.0, 0.1}) {
        Scene scene;
        scene.tilt.strength_px = strength_px;
        scene.blur.max_sigma_px = sigma_px;
        const ClipPlan plan = PlanClip(scene, {.size = {37, 21}}, {.max_error_levels = max_error_levels});
        noise::HashStream stream(2);
        const cv::Mat clean = RandomPicture({37 + 2 * plan.halo_px, 21 + 2 * plan.halo_px}, CV_32FC3, stream);
        const RenderedFrame frame = ClipRenderer(scene, plan, {0, 0}).Render(0, clean);
        ExpectBounded(frame.turb, -1, 2, 0);
        if (sigma_px < 0.3 && strength_px < 1) {  // nothing to be seen
          const cv::Mat inside = clean(cv::Rect({plan.halo_px, plan.halo_px}, frame.turb.size()));
          EXPECT_LT(cv::norm(frame.turb, inside, cv::NORM_INF), 1e-4) << sigma_px << " " << strength_px;
        }
      }
}

cv::Mat RenderOf(float sample) {
  const ClipPlan plan = PlanClip({}, {.size = {20, 10}}, {});
  cv::Mat clean(10 + 2 * plan.halo_px, 20 + 2 * plan.halo_px, CV_32FC3, cv::Scalar(0.5, 0.5, 0.5));
  clean.at<cv::Vec3f>(plan.halo_px + 5, plan.halo_px + 5)[1] = sample;
  return ClipRenderer({}, plan, {0, 0}).Render(0, clean).turb;
}

// What is no light is refused before it spreads; the rest stays finite and in proportion.
TEST(ClipsStress, SamplesThatAreNoLight) {
  using Limits = std::numeric_limits<float>;
  for (const float sample : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), 1e38f, -1e38f})
    EXPECT_THROW(RenderOf(sample), std::invalid_argument) << sample;
  ExpectBounded(RenderOf(-1), -1, 0.5, 0);
  ExpectBounded(RenderOf(65504), 0.5, 65504, 0);
  ExpectBounded(RenderOf(Limits::denorm_min()), 0, 0.5, 0);
}

}  // namespace
}  // namespace shimmer::sim
