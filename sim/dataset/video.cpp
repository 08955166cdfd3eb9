#include <cstdlib>
#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "sim/dataset/files.h"
#include "sim/dataset/frame_reader.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

// FFmpeg talks on stderr about what it dislikes in a file, and libraries must not print. OpenCV reads this
// when it first opens a video; set before main, where there is one thread.
const bool kFfmpegIsQuiet = setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", /*overwrite=*/0) == 0;

cv::VideoCapture Capture(const fs::path& path) {
  RequireFile(path);
  // Absolute, or else FFmpeg takes the start of a name like "12:30.avi" for a protocol.
  cv::VideoCapture capture(fs::absolute(path).string(), cv::CAP_FFMPEG);
  if (!capture.isOpened()) throw std::runtime_error(path.string() + ": not a video that can be read");
  return capture;
}

class Video : public FrameReader {
 public:
  Video(const fs::path& path, std::optional<int64_t> known_count, const std::atomic<bool>& stop)
      : path_(path), capture_(Capture(path)), count_(known_count), stop_(stop) {}

  int64_t count() override {
    if (!count_) {
      cv::VideoCapture counter = Capture(path_);
      const auto promised = static_cast<int64_t>(counter.get(cv::CAP_PROP_FRAME_COUNT));
      int64_t decoded = 0;
      while (Grab(counter)) ++decoded;
      if (decoded == 0) throw std::runtime_error(path_.string() + ": no frame of this video can be decoded");
      if (decoded < promised)
        remark_ = "its header promises " + std::to_string(promised) + " frames, " + std::to_string(decoded) +
                  " can be decoded";
      count_ = decoded;
    }
    return *count_;
  }

  Picture Read(int64_t frame) override {
    RequireFrame(frame, count());
    if (frame + 1 < next_frame_) {
      capture_ = Capture(path_);
      next_frame_ = 0;
    }
    for (; next_frame_ <= frame; ++next_frame_)
      if (!Grab(capture_))
        throw std::runtime_error(path_.string() + ": ends before frame " + std::to_string(frame));
    cv::Mat bgr;
    if (!capture_.retrieve(bgr) || bgr.type() != CV_8UC3)
      throw std::runtime_error(path_.string() + ": frame " + std::to_string(frame) + " can't be decoded");
    cv::Mat rgb(bgr.size(), CV_8UC3);
    cv::mixChannels({bgr}, {rgb}, {0, 2, 1, 1, 2, 0});
    return {.pixels = rgb};
  }

  std::string remark() const override { return remark_; }

  std::optional<double> frames_per_s() const override {
    const double rate = capture_.get(cv::CAP_PROP_FPS);
    return rate > 0 && rate < 1e4 ? std::optional(rate) : std::nullopt;  // 0 or nonsense: not known
  }

 private:
  // A frame is far from the next key frame, or the count of an hour of them: the person may not want to wait.
  bool Grab(cv::VideoCapture& capture) const {
    if (stop_) throw Interrupted();
    return capture.grab();
  }

  fs::path path_;
  cv::VideoCapture capture_;
  std::optional<int64_t> count_;
  int64_t next_frame_ = 0;  // what grab() takes next
  std::string remark_;
  const std::atomic<bool>& stop_;
};

}  // namespace

std::unique_ptr<FrameReader> OpenVideo(const fs::path& path, std::optional<int64_t> known_count,
                                       const std::atomic<bool>& stop) {
  return std::make_unique<Video>(path, known_count, stop);
}

}  // namespace shimmer::dataset
