// The fast blur of a 1920x1080 RGB frame on one thread: its pyramid, its bands and both, for every grade and
// maps of sigma from 0 to 2, 8 and 32 px, beside OpenCV's GaussianBlur, 11 levels of it, for a stack. error:
// measured RMS against the exact blur on a sample of rows, in 1/255; a broken promise is an error.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "sim/drawn/drawn.h"
#include "sim/exact_blur.h"
#include "sim/gaussian.h"
#include "sim/ladder_blur.h"
#include "sim/stack_blur.h"

namespace shimmer::sim {
namespace {

const cv::Size kSize(1920, 1080);
constexpr int kBandRows = 36;

// Every sigma from 0 to most, in cells of 40 px: nearly all levels are in use nearly everywhere.
cv::Mat BusyMap(double most_px) {
  cv::Mat cells(kSize / 40, CV_32F), map;
  cv::RNG random(1);
  random.fill(cells, cv::RNG::UNIFORM, 0, most_px);
  cv::resize(cells, map, kSize);
  return map;
}

cv::Mat Scene(int margin_px) { return DrawScene(DrawnScene::kBricks, kSize, margin_px, 1, 0); }

struct Job {
  Job(double most_px, LadderGrade grade) : ladder(LevelLadder::For(most_px, grade)), sigma(BusyMap(most_px)) {
    cv::split(Scene(ladder.margin_px()), frame);
    for (size_t c = 0; c < frame.size(); ++c) out.emplace_back(kSize, CV_32F);
  }

  void Bands(const LadderBlur& blur) {
    for (int y = 0; y < kSize.height; y += kBandRows) {
      const cv::Range rows(y, y + kBandRows);
      Planes band;
      for (cv::Mat& plane : out) band.push_back(plane.rowRange(rows));
      blur.Band({ladder.margin_px(), ladder.margin_px() + y}, sigma.rowRange(rows), band);
    }
  }

  // On pieces of rows all over the frame, its border included.
  double Error() const {
    double most;
    cv::minMaxLoc(sigma, nullptr, &most);
    const int margin = GaussianRadius(most);
    const cv::Mat wide = Scene(margin);
    constexpr int kPiecePx = 48;
    double sum = 0;
    int count = 0;
    std::vector<float> exact(3 * kPiecePx);
    for (int y = 0; y < kSize.height; y += 83)
      for (int x = 0; x < kSize.width; x += 312) {
        ExactBlurRow(wide, {x + margin, y + margin}, {sigma.ptr<float>(y) + x, kPiecePx}, exact.data());
        for (int i = 0; i < kPiecePx; ++i)
          for (int c = 0; c < 3; ++c, ++count) {
            const double error = 255 * (out[c].at<float>(y, x + i) - exact[3 * i + c]);
            sum += error * error;
          }
      }
    return std::sqrt(sum / count);
  }

  LevelLadder ladder;
  cv::Mat sigma;
  Planes frame, out;
};

void Pyramid(benchmark::State& state, double most_px, LadderGrade grade) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Job job(most_px, grade);
  for (auto _ : state) benchmark::DoNotOptimize(LadderBlur(job.frame, job.ladder));
}

void Bands(benchmark::State& state, double most_px, LadderGrade grade) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  Job job(most_px, grade);
  const LadderBlur blur(job.frame, job.ladder);
  for (auto _ : state) job.Bands(blur);
  state.counters["error"] = job.Error();
  if (job.Error() > PromiseOf(grade).levels) state.SkipWithError("the promise is broken");
}

void Both(benchmark::State& state, double most_px, LadderGrade grade) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  Job job(most_px, grade);
  for (auto _ : state) job.Bands(LadderBlur(job.frame, job.ladder));
}

// The levels alone, without choosing among them.
void OpenCvStack(benchmark::State& state, double most_px) {
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const cv::Mat frame = Scene(0);
  cv::Mat level;
  for (auto _ : state)
    for (int k = 1; k < kStackLevels; ++k)
      cv::GaussianBlur(frame, level, {}, most_px * k / (kStackLevels - 1));
  cv::setNumThreads(threads);
}

}  // namespace
}  // namespace shimmer::sim

int main(int argc, char** argv) {
  using namespace shimmer::sim;
  for (const double most_px : {2.0, 8.0, 32.0}) {
    const auto named = [&](const std::string& what, auto... run) {
      return benchmark::RegisterBenchmark(
                 (what + "/sigma_0_to_" + std::to_string(static_cast<int>(most_px))).c_str(), run..., most_px)
          ->Unit(benchmark::kMillisecond);
    };
    const char* names[] = {"fine", "standard", "coarse"};
    for (const LadderGrade grade : kLadderGrades) {
      const std::string name = names[static_cast<size_t>(grade)];
      named("pyramid/" + name, [grade](benchmark::State& s, double most) { Pyramid(s, most, grade); });
      named("bands/" + name, [grade](benchmark::State& s, double most) { Bands(s, most, grade); });
      named("both/" + name, [grade](benchmark::State& s, double most) { Both(s, most, grade); });
    }
    named("opencv_stack", [](benchmark::State& s, double most) { OpenCvStack(s, most); });
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
