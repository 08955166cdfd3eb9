#include "restore/stabilise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "tests/restore/frames.h"
#include "tests/restore/wave_scene.h"

namespace shimmer::restore {
namespace {

// Shifts of frames 0 .. count - 1, as they come.
std::vector<FrameShift> ShiftsOf(int count, const std::function<cv::Mat(int)>& frame,
                                 StabiliseParams params = {}) {
  Stabiliser stabiliser(params);
  std::vector<FrameShift> shifts;
  const auto take = [&](const std::vector<FrameShift>& known) {
    shifts.insert(shifts.end(), known.begin(), known.end());
  };
  for (int k = 0; k < count; ++k) {
    take(stabiliser.Next(frame(k)));
    const int due = k + 1 < params.first_frames ? 0 : k + 1;
    EXPECT_EQ(static_cast<int>(shifts.size()), due);
  }
  take(stabiliser.Rest());
  EXPECT_EQ(static_cast<int>(shifts.size()), count);
  return shifts;
}

struct Errors {
  double median = 0, max = 0;
  int not_found = 0;
};

Errors ErrorsOf(const std::vector<FrameShift>& shifts, const std::function<cv::Point2d(int)>& truth) {
  std::vector<double> sizes;
  Errors errors;
  for (size_t k = 0; k < shifts.size(); ++k) {
    sizes.push_back(cv::norm(shifts[k].px - truth(static_cast<int>(k))));
    errors.not_found += shifts[k].match != Match::kFound;
  }
  std::sort(sizes.begin(), sizes.end());
  errors.median = sizes[sizes.size() / 2], errors.max = sizes.back();
  return errors;
}

// Nothing but the shift: what is left is the resampling's and the levels' error.
TEST(Stabiliser, FindsShiftsOfPartsOfAPx) {
  for (const cv::Size size : {cv::Size(320, 240), cv::Size(331, 197), cv::Size(97, 401)}) {
    const double most = 0.3 * std::min(size.width, size.height);
    const auto truth = [&](int k) { return WanderingShift(k, most); };
    const auto shifts = ShiftsOf(8, [&](int k) { return SeenFrame({.size = size, .shift = truth(k)}); });
    const Errors errors = ErrorsOf(shifts, truth);
    EXPECT_EQ(errors.not_found, 0);
    EXPECT_LT(errors.max, 0.04) << size;
    EXPECT_EQ(shifts[0].px, cv::Point2d());
  }
}

// The full range at 1080p, under air that moves each part by 2 px along each axis: every frame within 0.5 px,
// the median within 0.1 (the air's own mean over the frame is some 0.01 px).
TEST(Stabiliser, At1080pUnderStrongTurbulenceUpTo400Px) {
  const std::vector<cv::Point2d> truth = {{0, 0}, {400, -400}, {-399.6, 387.2}, {-73.3, 12.6}};
  const auto at = [&](int k) { return truth[static_cast<size_t>(k)]; };
  const auto shifts = ShiftsOf(4, [&](int k) {
    cv::Mat frame;
    SeenFrame({.size = {1920, 1080},
               .shift = at(k),
               .tilt_rms_px = 2,
               .frame = static_cast<uint32_t>(k),
               .noise = 0.02})
        .convertTo(frame, CV_8U, 150, 50);
    return frame;
  });
  const Errors errors = ErrorsOf(shifts, at);
  EXPECT_EQ(errors.not_found, 0);
  EXPECT_LT(errors.max, 0.5);
  EXPECT_LT(errors.median, 0.1);
}

// 200 frames with light that doubles and falls, noise, air and a box that crosses the frame: errors at the
// end are no larger than those at the start, since no frame hands its error on.
TEST(Stabiliser, DoesNotDrift) {
  const cv::Size size(240, 180);
  const auto truth = [](int k) { return WanderingShift(k, 40); };
  const auto shifts = ShiftsOf(200, [&](int k) {
    return SeenFrame({.size = size,
                      .shift = truth(k),
                      .tilt_rms_px = 0.7,
                      .frame = static_cast<uint32_t>(k),
                      .gain = 1 + 0.5 * std::sin(0.03 * k),
                      .offset = 0.4 * std::sin(0.02 * k),
                      .noise = 0.02,
                      .box = {-60 + 2 * k % 300, 60, 50, 40}});
  });
  EXPECT_EQ(ErrorsOf(shifts, truth).not_found, 0);
  cv::Point2d early, late;
  for (int k = 1; k <= 40; ++k) {
    early += (shifts[static_cast<size_t>(k)].px - truth(k)) / 40;
    late += (shifts[static_cast<size_t>(159 + k)].px - truth(159 + k)) / 40;
  }
  EXPECT_LT(ErrorsOf(shifts, truth).max, 0.5);
  EXPECT_LT(cv::norm(late - early), 0.06) << early << late;
}

// A box over a seventh of the frame that goes on by 3 px a frame does not take the camera along.
TEST(Stabiliser, DoesNotFollowAnObject) {
  const auto truth = [](int k) { return WanderingShift(k, 30); };
  const auto shifts = ShiftsOf(30, [&](int k) {
    return SeenFrame({.size = {320, 240},
                      .shift = truth(k),
                      .tilt_rms_px = 0.5,
                      .frame = static_cast<uint32_t>(k),
                      .box = {20 + 3 * k + cvRound(truth(k).x), 80 + cvRound(truth(k).y), 120, 90}});
  });
  const Errors errors = ErrorsOf(shifts, truth);
  EXPECT_EQ(errors.not_found, 0);
  EXPECT_LT(errors.max, 0.3);
}

// The scene has a level of texture, an object in front of it thirty times as much. Over a seventh of the
// frame it is not followed. Over a third it is, as things stand, since its edges hide what is faint beside
// them: then no frame says that it is sure.
TEST(Stabiliser, DoesNotFollowAnObjectOverLittleTextureUnsaid) {
  const cv::Size size(320, 240);
  const auto truth = [](int k) { return WanderingShift(k, 30); };
  const auto shifts_with = [&](cv::Size box) {
    return ShiftsOf(16, [&](int k) {
      View view{.size = size, .shift = truth(k), .tilt_rms_px = 0.5, .frame = static_cast<uint32_t>(k)};
      view.gain = 0.03;
      cv::Mat frame = SeenFrame(view);
      view.gain = 1;
      view.box = cv::Rect({30 + 3 * k + cvRound(truth(k).x), 60 + cvRound(truth(k).y)}, box);
      const cv::Rect seen = view.box & cv::Rect({0, 0}, size);
      SeenFrame(view)(seen).copyTo(frame(seen));
      return frame;
    });
  };
  const auto small = shifts_with({120, 90});
  EXPECT_EQ(ErrorsOf(small, truth).not_found, 0);
  EXPECT_LT(ErrorsOf(small, truth).max, 0.3);
  EXPECT_EQ(std::ranges::count(small, true, &FrameShift::unsure), 0);
  const auto large = shifts_with({190, 135});
  EXPECT_TRUE(ErrorsOf(large, truth).max < 0.3 ||
              std::ranges::count(large, true, &FrameShift::unsure) == std::ssize(large));
}

// An object over half of what is to be seen is followed or it is not: which of the two moves can't be told,
// and that is said. In the frames of an object over a seventh it is not.
TEST(Stabiliser, IsUnsureWhereHalfOfTheFrameMovesOtherwise) {
  const auto unsure = [](int width) {
    const auto shifts = ShiftsOf(12, [&](int k) {
      return SeenFrame({.size = {320, 240},
                        .tilt_rms_px = 0.5,
                        .frame = static_cast<uint32_t>(k),
                        .box = {20 + 6 * k, 20, width, 200}});
    });
    return std::ranges::count(shifts, true, &FrameShift::unsure);
  };
  EXPECT_GE(unsure(190), 11);
  EXPECT_EQ(unsure(55), 0);
}

// Under air of other strengths and lengths of wave, clip by clip: 95 % of frames are within error_px, and it
// is no more than some ten times the errors.
TEST(Stabiliser, ErrorIsWhatItPromises) {
  int within = 0, all = 0;
  double errors = 0, promised = 0;
  for (uint32_t clip = 0; clip < 4; ++clip) {
    const auto truth = [](int k) { return WanderingShift(k, 20); };
    const auto shifts = ShiftsOf(9, [&](int k) {
      return SeenFrame({.size = {240, 180},
                        .shift = truth(k),
                        .tilt_rms_px = 0.5 + 0.5 * clip,
                        .frame = 100 * clip + static_cast<uint32_t>(k),
                        .noise = 0.01});
    });
    EXPECT_EQ(shifts[0].error_px, 0);
    for (size_t k = 1; k < shifts.size(); ++k, ++all) {
      const double error = cv::norm(shifts[k].px - truth(static_cast<int>(k)));
      within += error <= shifts[k].error_px;
      errors += error, promised += shifts[k].error_px;
    }
  }
  EXPECT_GE(within, 0.95 * all);
  EXPECT_LT(promised, 10 * errors);
}

// Bits, channels and their order do not matter.
TEST(Stabiliser, IsTheSameForEveryKindOfFrame) {
  const auto truth = [](int k) { return WanderingShift(k, 20); };
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_32FC1, CV_32FC3}) {
    const double scale = CV_MAT_DEPTH(type) == CV_8U ? 150 : CV_MAT_DEPTH(type) == CV_16U ? 40000 : 1;
    const auto shifts = ShiftsOf(4, [&](int k) {
      cv::Mat frame;
      SeenFrame({.size = {160, 120}, .shift = truth(k)})
          .convertTo(frame, CV_MAT_DEPTH(type), scale, scale / 3);
      const std::vector<cv::Mat> channels(static_cast<size_t>(CV_MAT_CN(type)), frame);
      cv::merge(channels, frame);
      return frame;
    });
    EXPECT_LT(ErrorsOf(shifts, truth).max, 0.05) << cv::typeToString(type);
  }
}

TEST(Stabiliser, TinyFrames) {
  for (const cv::Size size : {cv::Size(64, 64), cv::Size(65, 71), cv::Size(64, 500)}) {
    const auto truth = [&](int k) { return k * cv::Point2d(6.5, -4.25); };
    const auto shifts = ShiftsOf(2, [&](int k) { return SeenFrame({.size = size, .shift = truth(k)}); });
    EXPECT_LT(ErrorsOf(shifts, truth).max, 0.1) << size;
  }
}

// Two crops of one picture.
TEST(Stabiliser, FramesOf4K) {
  cv::Mat picture(2160 + 400, 3840 + 800, CV_8UC1);
  cv::RNG(3).fill(picture, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(picture, picture, {0, 0}, 6);
  const cv::Point first(600, 100), second(0, 400);
  const auto truth = [&](int k) { return k == 0 ? cv::Point2d() : cv::Point2d(first - second); };
  const auto shifts = ShiftsOf(2, [&](int k) {
    return picture({k == 0 ? first : second, cv::Size(3840, 2160)}).clone();
  });
  EXPECT_EQ(shifts[1].match, Match::kFound);
  EXPECT_LT(ErrorsOf(shifts, truth).max, 0.1);
}

TEST(Stabiliser, OneFrameAndFramesAllAlike) {
  const cv::Mat frame = SeenFrame({.size = {100, 80}});
  const auto one = ShiftsOf(1, [&](int) { return frame; });
  EXPECT_EQ(one[0].px, cv::Point2d());
  EXPECT_EQ(one[0].match, Match::kFound);
  for (const FrameShift& shift : ShiftsOf(30, [&](int) { return frame; })) {
    EXPECT_LT(cv::norm(shift.px), 1e-3);
    EXPECT_EQ(shift.match, Match::kFound);
  }
  Stabiliser none;
  EXPECT_TRUE(none.Rest().empty());
}

// Black, of one colour, or with single samples that are no number: nothing is to be seen, and s stays.
TEST(Stabiliser, FlatFramesAreFlat) {
  for (const double level : {0.0, 0.4})
    for (const FrameShift& shift : ShiftsOf(3, [&](int k) {
           cv::Mat frame(60, 80, CV_32FC1, cv::Scalar(level));
           if (level == 0 && k == 1) frame.at<float>(7, 9) = std::numeric_limits<float>::quiet_NaN();
           return frame;
         })) {
      EXPECT_EQ(shift.match, Match::kFlat);
      EXPECT_EQ(shift.px, cv::Point2d());
    }
  // Black before and within a video that shows something.
  const auto truth = [](int k) { return cv::Point2d(3 * (k - 2), 1.5 * (k - 2)); };
  const auto shifts = ShiftsOf(6, [&](int k) {
    const bool black = k < 2 || k == 4;
    return black ? cv::Mat(cv::Mat::zeros(120, 160, CV_32FC1))
                 : SeenFrame({.size = {160, 120}, .shift = truth(k)});
  });
  const cv::Point2d expected[] = {{0, 0}, {0, 0}, {0, 0}, truth(3), truth(3), truth(5)};
  for (size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(shifts[k].match, k < 2 || k == 4 ? Match::kFlat : Match::kFound) << k;
    EXPECT_LT(cv::norm(shifts[k].px - expected[k]), 0.05) << k;
  }
}

// A frame of another scene, or of noise, holds the last shift, within the first frames and after them; what
// comes after it is found again.
TEST(Stabiliser, FramesOfAnotherSceneAreLost) {
  const auto truth = [](int k) { return WanderingShift(k, 30); };
  for (const int first_frames : {24, 3}) {
    const auto shifts = ShiftsOf(8,
                                 [&](int k) {
                                   cv::Mat frame = SeenFrame({.size = {320, 240}, .shift = truth(k)});
                                   if (k == 4) {
                                     cv::RNG random(5);
                                     random.fill(frame, cv::RNG::UNIFORM, 0, 1);
                                   }
                                   if (k == 5)
                                     cv::flip(frame.t(), frame, 0), cv::resize(frame, frame, {320, 240});
                                   return frame;
                                 },
                                 {.first_frames = first_frames});
    for (int k = 0; k < 8; ++k) {
      const FrameShift& shift = shifts[static_cast<size_t>(k)];
      const bool lost = k == 4 || k == 5;
      EXPECT_EQ(shift.match, lost ? Match::kLost : Match::kFound) << k << " " << shift.correlation;
      EXPECT_LT(cv::norm(shift.px - truth(lost ? 3 : k)), 0.05) << k;
    }
    EXPECT_EQ(shifts[4].px, shifts[3].px);
  }
}

// A slope, and noise over it, which is another in each frame: the same scene still. Were
// the slope another's, it would be another scene.
TEST(Stabiliser, FramesAlikeInWhatIsCoarseAreOfOneScene) {
  const cv::Size size{160, 120};
  const auto misty = [&](int k) {
    cv::Mat slope(1, 2, CV_32FC1), frame, detail;
    slope.at<float>(0) = k == 5 ? 0.7f : 0.3f, slope.at<float>(1) = k == 5 ? 0.3f : 0.7f;
    cv::resize(slope, frame, size, 0, 0, cv::INTER_LINEAR);
    Noise(size, CV_32FC1, static_cast<uint32_t>(k)).convertTo(detail, CV_32F, 0.2);
    return cv::Mat(frame + detail);
  };
  const auto shifts = ShiftsOf(8, misty);
  for (size_t k = 1; k < 8; ++k) {
    EXPECT_EQ(shifts[k].match, k == 5 ? Match::kLost : Match::kFlat) << k;
    EXPECT_EQ(shifts[k].px, cv::Point2d()) << k;
  }
}

// To the last bit, for a build and a machine.
TEST(Stabiliser, IsTheSameOnAnyNumberOfThreads) {
  const auto shifts = [](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return ShiftsOf(5, [](int k) {
      return SeenFrame({.size = {320, 240},
                        .shift = WanderingShift(k, 30),
                        .tilt_rms_px = 1,
                        .frame = static_cast<uint32_t>(k)});
    });
  };
  const auto one = shifts(1), four = shifts(4);
  for (size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].px, four[k].px) << k;
    EXPECT_EQ(one[k].correlation, four[k].correlation) << k;
  }
}

TEST(Stabiliser, MaxShiftIsTheMost) {
  const auto seen = [](int k) { return SeenFrame({.size = {320, 240}, .shift = {k * 60.0, 0}}); };
  EXPECT_EQ(ShiftsOf(2, seen, {.max_shift_px = 30})[1].match, Match::kLost);
  EXPECT_EQ(ShiftsOf(2, seen, {.max_shift_px = 60})[1].match, Match::kFound);
}

TEST(Stabiliser, RefusesBadInput) {
  EXPECT_THROW(Stabiliser({.max_shift_px = -1}), std::invalid_argument);
  EXPECT_THROW(Stabiliser({.max_shift_px = std::numeric_limits<double>::infinity()}), std::invalid_argument);
  EXPECT_THROW(Stabiliser({.first_frames = 0}), std::invalid_argument);
  Stabiliser stabiliser;
  EXPECT_THROW(stabiliser.Next({}), std::invalid_argument);
  EXPECT_THROW(stabiliser.Next(cv::Mat::zeros(15, 40, CV_8UC1)), std::invalid_argument);
  EXPECT_THROW(stabiliser.Next(cv::Mat::zeros(40, 40, CV_64FC1)), std::invalid_argument);
  Stabiliser other;
  other.Next(cv::Mat::zeros(40, 40, CV_8UC1));
  EXPECT_THROW(other.Next(cv::Mat::zeros(40, 41, CV_8UC1)), std::invalid_argument);
  EXPECT_THROW(other.Next(cv::Mat::zeros(40, 40, CV_8UC3)), std::invalid_argument);
}

TEST(IsSteady, BelowHalfAPx) {
  EXPECT_TRUE(IsSteady({}));
  const std::vector<FrameShift> still = {{.px = {0, 0}}, {.px = {0.49, -0.4}}};
  EXPECT_TRUE(IsSteady(still));
  const std::vector<FrameShift> moved = {{.px = {0, 0}}, {.px = {0, -0.5}}};
  EXPECT_FALSE(IsSteady(moved));
  // A camera that stands, seen through air of medium strength.
  EXPECT_TRUE(IsSteady(ShiftsOf(30, [](int k) {
    return SeenFrame({.size = {320, 240}, .tilt_rms_px = 1, .frame = static_cast<uint32_t>(k)});
  })));
}

// A row of frames: found (+), lost (-), of one colour (o).
std::vector<FrameShift> Matches(const std::string& row) {
  std::vector<FrameShift> shifts;
  for (const char kind : row)
    shifts.push_back({.match = kind == '+' ? Match::kFound : kind == '-' ? Match::kLost : Match::kFlat});
  return shifts;
}

TEST(AreOfOneScene, WhereHalfOfThemAreFound) {
  EXPECT_TRUE(AreOfOneScene({}));
  EXPECT_TRUE(AreOfOneScene(Matches("oooo")));
  EXPECT_TRUE(AreOfOneScene(Matches("+-+-ooo")));
  EXPECT_FALSE(AreOfOneScene(Matches("+-+--ooo")));
}

TEST(LastingCut, IsWhereAnotherSceneBegins) {
  EXPECT_EQ(LastingCut(Matches("++++++++--------")), 8u);
  EXPECT_EQ(LastingCut(Matches("++-+++++++ooo-------o-")), 13u);
  EXPECT_FALSE(LastingCut(Matches("++++++++-------")));            // a short loss at the end
  EXPECT_FALSE(LastingCut(Matches("+++++++--------")));            // hardly a scene before
  EXPECT_FALSE(LastingCut(Matches("++++++++----------------+")));  // what hid the scene goes away again
  EXPECT_FALSE(LastingCut(Matches("++++++++oooooooooo")));         // it fades
  EXPECT_FALSE(LastingCut({}));
}

TEST(CommonArea, IsSeenByAll) {
  const std::vector<FrameShift> shifts = {{.px = {0, 0}}, {.px = {10, -3}}, {.px = {-2.5, 4.25}}};
  EXPECT_EQ(CommonArea(shifts, {100, 50}), cv::Rect(3, 3, 87, 42));
  const std::vector<FrameShift> apart = {{.px = {60, 0}}, {.px = {-60, 0}}};
  EXPECT_TRUE(CommonArea(apart, {100, 50}).empty());
}

}  // namespace
}  // namespace shimmer::restore
