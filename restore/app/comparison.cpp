#include "restore/app/comparison.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <stdexcept>

#include "cli/number_text.h"
#include "restore/levels.h"
#include "restore/line_deviation.h"
#include "restore/mask_scores.h"
#include "restore/psnr.h"
#include "restore/ssim.h"

namespace shimmer::restore::app {
namespace {

// What one frame is measured on.
struct FramePair {
  int64_t frame = 0;
  cv::Mat a, b, a_before, b_before;  // the last two empty in the first frame, and for a still
  cv::Mat moving;                    // in this frame or the one before; empty: nothing
};

// Takes the frames of all readers in order.
class PairReader {
 public:
  explicit PairReader(const ComparisonTask& task) : task_(task), count_(task.a.frames.count()) {
    RequireCount(task.b);
    if (task.mask) RequireCount(*task.mask);
    b_is_still_ = task.b.frames.count() == 1;
  }

  int64_t count() const { return count_; }
  bool b_is_still() const { return b_is_still_; }
  cv::Size size() const { return last_.a.size(); }  // once a frame is read
  cv::Mat slice(size_t which) const { return slices_ ? (*slices_)[which].picture() : cv::Mat(); }

  FramePair Next() {
    FramePair next;
    next.frame = next_frame_++;
    const bool first = next.frame == 0;
    next.a = task_.a.frames.Read(next.frame).pixels;
    next.b = first || !b_is_still_ ? task_.b.frames.Read(next.frame).pixels : last_.b;
    RequireSize(task_.b, next.b, next.a.size());
    if (!first) next.a_before = last_.a;
    if (!first && !b_is_still_) next.b_before = last_.b;
    if (task_.mask) {
      const cv::Mat earlier = moving_;
      if (first || task_.mask->frames.count() > 1) {
        const cv::Mat mask = task_.mask->frames.Read(next.frame).pixels;
        RequireSize(*task_.mask, mask, next.a.size());
        moving_ = MovingPixels(mask);
      }
      next.moving = first ? moving_ : cv::Mat(moving_ | earlier);
    }
    if (task_.slices) AddToSlices(next);
    return last_ = next;
  }

 private:
  void RequireCount(const Compared& other) const {
    const int64_t count = other.frames.count();
    if (count == count_ || count == 1) return;
    throw std::invalid_argument(other.name + ": has " + cli::Counted(count, "frame") + ", must have " +
                                (count_ == 1 ? "" : cli::Grouped(count_) + " as " + task_.a.name + ", or ") +
                                "1" + (count_ == 1 ? " as " + task_.a.name : ""));
  }

  void RequireSize(const Compared& other, const cv::Mat& frame, cv::Size size) const {
    if (frame.size() != size)
      throw std::invalid_argument(other.name + ": is " + SizeText(frame.size()) + " px, must be " +
                                  SizeText(size) + " as " + task_.a.name);
  }

  void AddToSlices(const FramePair& pair) {
    if (!slices_) {
      const int row = task_.slice_row.value_or(pair.a.rows / 2);
      slices_ = std::array{TimeSlice(row), TimeSlice(row)};
    }
    (*slices_)[0].Add(pair.a);
    if (pair.frame == 0 || !b_is_still_) (*slices_)[1].Add(pair.b);
  }

  const ComparisonTask& task_;
  int64_t count_, next_frame_ = 0;
  bool b_is_still_ = false;
  FramePair last_;
  cv::Mat moving_;  // in the last frame
  std::optional<std::array<TimeSlice, 2>> slices_;
};

FrameScores MasksMeasured(const FramePair& pair) {
  const MaskCounts counts = CompareMasks(pair.a, pair.b);
  FrameScores scores;
  scores.iou = counts.Iou();
  scores.precision = counts.Precision();
  scores.recall = counts.Recall();
  return scores;
}

FrameScores Measured(const FramePair& pair, bool b_is_still) {
  FrameScores scores;
  scores.psnr_db = Psnr(pair.a, pair.b);
  scores.ssim_opencv = SsimOpenCv(pair.a, pair.b);
  scores.ssim_scikit_image = SsimScikitImage(pair.a, pair.b);
  scores.psnr_y_db = PsnrY(pair.a, pair.b);
  scores.ssim_y = SsimY(pair.a, pair.b);
  scores.line_deviation_deg[0] = LineDeviation_deg(pair.a);
  if (pair.frame == 0 || !b_is_still) scores.line_deviation_deg[1] = LineDeviation_deg(pair.b);
  if (!pair.a_before.empty())
    scores.difference_levels[0] = FrameDifference(pair.a_before, pair.a, pair.moving);
  if (!pair.b_before.empty())
    scores.difference_levels[1] = FrameDifference(pair.b_before, pair.b, pair.moving);
  return scores;
}

}  // namespace

Comparison CompareSequences(const ComparisonTask& task, const std::atomic<bool>& stop,
                            const std::function<void()>& step) {
  PairReader reader(task);
  Comparison result;
  result.are_masks = task.are_masks;
  result.b_is_still = reader.b_is_still();
  const int threads = task.threads > 0 ? task.threads : tbb::info::default_concurrency();
  // An arena may have more threads than processors only where this allows it; oneTBB prints a warning
  // otherwise.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  int64_t read = 0;
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_pipeline(static_cast<size_t>(threads) + 1,
                           tbb::make_filter<void, FramePair>(tbb::filter_mode::serial_in_order,
                                                             [&](tbb::flow_control& control) {
                                                               if (read == reader.count() || stop) {
                                                                 control.stop();
                                                                 return FramePair();
                                                               }
                                                               ++read;
                                                               return reader.Next();
                                                             }) &
                               tbb::make_filter<FramePair, FrameScores>(
                                   tbb::filter_mode::parallel,
                                   [&](const FramePair& pair) {
                                     return task.are_masks ? MasksMeasured(pair)
                                                           : Measured(pair, result.b_is_still);
                                   }) &
                               tbb::make_filter<FrameScores, void>(tbb::filter_mode::serial_in_order,
                                                                   [&](const FrameScores& scores) {
                                                                     result.frames.push_back(scores);
                                                                     step();
                                                                   }));
  });
  if (stop) throw dataset::Interrupted();
  result.size = reader.size();
  for (size_t i = 0; i < 2; ++i) result.slices[i] = reader.slice(i);
  return result;
}

}  // namespace shimmer::restore::app
