#include "tests/bench/sharpen_frames.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "restore/open_network.h"
#include "restore/sharpen.h"
#include "tests/bench/table.h"

namespace shimmer::bench {
namespace {

namespace fs = std::filesystem;
using restore::Sharpener;
using restore::SharpeningNetwork;

std::vector<cv::Mat> FramesIn(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::ranges::sort(paths);
  std::vector<cv::Mat> frames;
  for (const fs::path& path : paths) {
    cv::Mat frame = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
    if (frame.empty()) throw std::runtime_error(path.string() + ": is no picture");
    if (frame.channels() == 3) cv::cvtColor(frame, frame, cv::COLOR_BGR2RGB);
    frames.push_back(frame);
  }
  if (frames.size() < 2) throw std::runtime_error(folder.string() + ": must hold two pictures or more");
  return frames;
}

struct Sharpened {
  std::vector<cv::Mat> frames;
  std::vector<double> ms;  // of all but the first
  restore::SharpenCounts counts;

  double Median() const {
    std::vector<double> sorted = ms;
    std::ranges::nth_element(sorted, sorted.begin() + std::ssize(sorted) / 2);
    return sorted[sorted.size() / 2];
  }
};

Sharpened SharpenAll(std::shared_ptr<SharpeningNetwork> network, const std::vector<cv::Mat>& frames,
                     const restore::SharpenParams& params) {
  using Clock = std::chrono::steady_clock;
  Sharpener sharpener(std::move(network), frames[0].size(), params);
  Sharpened done;
  for (const cv::Mat& frame : frames) {
    const Clock::time_point start = Clock::now();
    done.frames.push_back(sharpener.Next(frame));
    if (done.frames.size() > 1)
      done.ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  done.counts = sharpener.counts();
  return done;
}

double MeanRms(const Sharpened& a, const Sharpened& b, double& most) {
  double sum = 0;
  most = 0;
  for (size_t k = 0; k < a.frames.size(); ++k) {
    const double white = a.frames[k].depth() == CV_8U ? 255 : a.frames[k].depth() == CV_16U ? 65535 : 1;
    const double rms = 255 / white * cv::norm(a.frames[k], b.frames[k], cv::NORM_L2) /
                       std::sqrt(static_cast<double>(a.frames[k].total() * a.frames[k].channels()));
    sum += rms;
    most = std::max(most, rms);
  }
  return sum / static_cast<double>(a.frames.size());
}

// The same network with a tile that holds all of a frame.
class InOne : public SharpeningNetwork {
 public:
  explicit InOne(std::shared_ptr<SharpeningNetwork> network) : network_(std::move(network)) {}
  std::string name() const override { return network_->name(); }
  restore::TileSize tile() const override { return {.side_px = 1 << 20, .overlap_px = 0}; }
  cv::Mat Sharpened(const cv::Mat& picture) override { return network_->Sharpened(picture); }

 private:
  std::shared_ptr<SharpeningNetwork> network_;
};

}  // namespace

nlohmann::ordered_json SharpenFrames(const fs::path& folder, const fs::path& model) {
  const std::vector<cv::Mat> frames = FramesIn(folder);
  const auto network = model.empty() ? restore::ShippedNetwork() : restore::OpenNetwork(model);
  const restore::SharpenParams always{.kept_levels = 0, .kept_local_levels = 0, .flat_levels = -1};
  const Sharpened anew = SharpenAll(network, frames, always), skipped = SharpenAll(network, frames, {}),
                  whole = SharpenAll(std::make_shared<InOne>(network), frames, always);
  const auto tiles = static_cast<double>(skipped.counts.computed + skipped.counts.kept + skipped.counts.flat);
  double most_skip = 0, most_tile = 0;
  const double skip = MeanRms(anew, skipped, most_skip), tile = MeanRms(anew, whole, most_tile);
  Table table({"frames", "ms anew", "in one piece", "with what is kept", "kept", "flat",
               "RMS of keeping, most", "RMS of tiles, most"});
  table.Add({std::to_string(frames.size()) + " of " + SizeText(frames[0].size()), Number(anew.Median(), 0),
             Number(whole.Median(), 0), Number(skipped.Median(), 0),
             Number(100 * static_cast<double>(skipped.counts.kept) / tiles, 1) + " %",
             Number(100 * static_cast<double>(skipped.counts.flat) / tiles, 1) + " %",
             Number(skip, 3) + ", " + Number(most_skip, 3), Number(tile, 3) + ", " + Number(most_tile, 3)});
  table.Print();
  return {{"frames", frames.size()},
          {"ms_anew", anew.Median()},
          {"ms_whole", whole.Median()},
          {"ms_kept", skipped.Median()},
          {"computed", skipped.counts.computed},
          {"kept", skipped.counts.kept},
          {"flat", skipped.counts.flat},
          {"rms_keeping", skip},
          {"most_rms_keeping", most_skip},
          {"rms_tiles", tile},
          {"most_rms_tiles", most_tile}};
}

}  // namespace shimmer::bench
