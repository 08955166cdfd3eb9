#include "restore/app/frame_sink.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

#include "sim/dataset/files.h"
#include "sim/dataset/image_io.h"
#include "sim/dataset/numbered_name.h"
#include "sim/dataset/video_write.h"

namespace shimmer::restore::app {
namespace {

namespace fs = std::filesystem;

fs::path PartOf(const fs::path& path) { return path.string() + ".part"; }

class FolderSink : public FrameSink {
 public:
  explicit FolderSink(fs::path path) : path_(std::move(path)), part_(PartOf(path_)) {
    fs::remove_all(part_);
    dataset::MakeFolders(part_);
  }
  ~FolderSink() override {
    std::error_code ignored;
    fs::remove_all(part_, ignored);
  }

  void Add(const cv::Mat& frame) override {
    const bool floats = frame.depth() == CV_32F;
    const dataset::Encoding encoding{.format = floats ? dataset::FileFormat::kExr : dataset::FileFormat::kPng,
                                     .bits = frame.depth() == CV_8U ? 8 : 16};
    const std::string name = dataset::Padded(count_++, 4) + "." + dataset::Extension(encoding.format);
    const cv::Mat whole = frame.isContinuous() ? frame : frame.clone();
    dataset::WriteFileAtomically(part_ / name, dataset::EncodeImage(whole, encoding));
  }
  void Finish() override { dataset::Rename(part_, path_); }

 private:
  fs::path path_, part_;
  int64_t count_ = 0;
};

class VideoSink : public FrameSink {
 public:
  VideoSink(fs::path path, double frames_per_s)
      : path_(std::move(path)),
        part_(path_.parent_path() / (path_.stem().string() + ".part" + path_.extension().string())),
        frames_per_s_(frames_per_s) {}
  ~VideoSink() override {
    writer_.reset();
    std::error_code ignored;
    fs::remove(part_, ignored);
  }

  void Add(const cv::Mat& frame) override {
    if (!writer_) {
      dataset::MakeFolders(fs::absolute(part_).parent_path());
      writer_ = std::make_unique<dataset::VideoWriter>(part_, frame.size(), frames_per_s_);
    }
    const cv::Mat samples =
        frame.depth() == CV_8U ? frame : dataset::ToSamples(dataset::FromSamples(frame), {.bits = 8});
    writer_->Add(samples);
  }
  void Finish() override {
    writer_.reset();
    dataset::Rename(part_, path_);
  }

 private:
  fs::path path_, part_;
  double frames_per_s_;
  std::unique_ptr<dataset::VideoWriter> writer_;
};

}  // namespace

std::unique_ptr<FrameSink> OpenSink(const fs::path& path, double frames_per_s) {
  const fs::path plain = path.has_filename() ? path : path.parent_path();
  if (fs::exists(plain) && !(fs::is_directory(plain) && fs::is_empty(plain)))
    throw std::invalid_argument("--out " + path.string() +
                                ": is there already, must be new or an empty folder");
  if (dataset::IsVideoName(plain)) return std::make_unique<VideoSink>(plain, frames_per_s);
  return std::make_unique<FolderSink>(plain);
}

}  // namespace shimmer::restore::app
