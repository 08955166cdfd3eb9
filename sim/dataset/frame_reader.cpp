#include "sim/dataset/frame_reader.h"

#include <stdexcept>
#include <vector>

#include "sim/dataset/files.h"
#include "sim/dataset/sources.h"

namespace shimmer::dataset {
namespace {

namespace fs = std::filesystem;

class PictureFiles : public FrameReader {
 public:
  PictureFiles(std::vector<fs::path> files, PictureCache* cache) : files_(std::move(files)), cache_(cache) {}

  int64_t count() override { return static_cast<int64_t>(files_.size()); }

  Picture Read(int64_t frame) override {
    RequireFrame(frame, count());
    Picture picture = cache_ ? *cache_->Read(files_[frame]) : ReadSamples(files_[frame]);
    if (first_.empty()) {
      first_ = picture.pixels.size();
      first_channels_ = picture.pixels.channels();
      first_file_ = files_[frame];
    } else if (picture.pixels.size() != first_ || picture.pixels.channels() != first_channels_) {
      throw std::runtime_error(files_[frame].string() + ": another size or number of channels than " +
                               first_file_.string());
    }
    return picture;
  }

 private:
  std::vector<fs::path> files_;
  PictureCache* cache_;
  cv::Size first_;
  int first_channels_ = 0;
  fs::path first_file_;
};

}  // namespace

void FrameReader::RequireFrame(int64_t frame, int64_t count) {
  if (frame < 0 || frame >= count)
    throw std::invalid_argument("frame = " + std::to_string(frame) + ", must be in [0, " +
                                std::to_string(count - 1) + "]");
}

std::unique_ptr<FrameReader> OpenStill(const fs::path& path, PictureCache* cache) {
  RequireFile(path);
  return std::make_unique<PictureFiles>(std::vector<fs::path>{path}, cache);
}

std::unique_ptr<FrameReader> OpenSequence(const fs::path& sequence, PictureCache* cache) {
  return std::make_unique<PictureFiles>(SequenceFiles(sequence), cache);
}

}  // namespace shimmer::dataset
