#include "sim/app/clean_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "sim/colour.h"
#include "sim/crop.h"
#include "sim/drawn/drawn.h"

namespace shimmer::app {
namespace {

std::string SizeText(cv::Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

bool Holds(cv::Size outer, cv::Size inner) {
  return outer.width >= inner.width && outer.height >= inner.height;
}

}  // namespace

cv::Size Scaled(cv::Size size, double scale) {
  return {std::max(1, static_cast<int>(std::lround(size.width * scale))),
          std::max(1, static_cast<int>(std::lround(size.height * scale)))};
}

dataset::Encoding EncodingOf(const OutputParams& output) {
  return {.format = output.format == Format::kPng ? dataset::FileFormat::kPng : dataset::FileFormat::kExr,
          .bits = output.bits,
          .png_writer = output.png_writer == PngWriter::kIsal ? dataset::PngWriter::kIsal
                                                              : dataset::PngWriter::kOpenImageIo};
}

bool OutputIsLinear(const Config& config) {
  return config.colour == sim::Colour::kLinear && config.output.format == Format::kExr;
}

CleanFrames::CleanFrames(const SourceList& sources, dataset::PictureCache& pictures, const Config& config,
                         sim::ClipKey key, const std::atomic<bool>& stop)
    : sources_(sources), config_(config), key_(key) {
  flip_ = config.source.flip && sim::DrawUnit(key, "source.flip") < 0.5;
  record_["flip"] = flip_;
  if (sources.kind() == SourceKind::kDrawn) {
    record_["drawn"] = config.source.drawn;
    record_["scale"] = config.source.scale;
    variation_ = static_cast<uint64_t>(sim::DrawInteger(key, "source.variation", 0, INT64_MAX - 1));
    record_["variation"] = variation_;
    return;
  }
  item_ = static_cast<size_t>(
      sim::DrawInteger(key, "source.item", 0, static_cast<int64_t>(sources.items().size()) - 1));
  record_.update(sources.Record(item_));
  reader_ = sources.Open(item_, pictures, stop);
  if (const std::string remark = sources.Remark(item_); !remark.empty()) record_["remark"] = remark;
  if (still()) return;

  const int64_t needed = config.first_frame + config.frames, spare = reader_->count() - needed;
  if (spare < 0)
    throw std::runtime_error(sources.items()[item_].string() + ": has " + std::to_string(reader_->count()) +
                             " frames, must have at least " + std::to_string(needed) +
                             " (first_frame + frames)");
  if (config.source.start == Start::kRandom) start_ = sim::DrawInteger(key, "source.start", 0, spare);
  record_["start"] = start_;
}

bool CleanFrames::still() const { return sources_.still(); }

cv::Mat CleanFrames::Frame(int64_t t, int halo_px) {
  if (still() && halo_px == still_halo_px_) return still_frame_;
  cv::Mat frame;
  if (reader_) {
    frame = Prepare(reader_->Read(still() ? 0 : start_ + t), halo_px);
  } else {
    frame = Prepare({.pixels = sim::DrawScene(sim::DrawnSceneNamed(config_.source.drawn), config_.size,
                                              halo_px, config_.source.scale, variation_)},
                    halo_px);
  }
  if (still()) still_frame_ = frame, still_halo_px_ = halo_px;
  return frame;
}

cv::Mat CleanFrames::Prepare(const dataset::Picture& picture, int halo_px) {
  cv::Mat pixels = picture.pixels;
  if (reader_) {  // drawn scenes are drawn at their size, halo and all
    const double scale = FittingScale(pixels.size());
    const cv::Size scaled = Scaled(pixels.size(), scale);
    const cv::Rect crop = ChooseCrop(scaled);
    pixels = sim::ResizedCropWithHalo(pixels, scaled, crop, halo_px);
    record_["scale"] = scale;
    record_["crop"] = {crop.x, crop.y, crop.width, crop.height};
    if (picture.alpha_dropped) record_["alpha_dropped"] = true;
    if (picture.replaced > 0)
      record_["replaced_samples"] = record_.value("replaced_samples", int64_t{0}) + picture.replaced;
  }
  if (flip_) cv::flip(pixels, pixels, 1);
  if (config_.colour == sim::Colour::kLinear && picture.linear != OutputIsLinear(config_))
    pixels = picture.linear ? sim::EncodeSrgb(pixels) : sim::DecodeSrgb(pixels);
  const dataset::Encoding encoding = EncodingOf(config_.output);
  return encoding.format == dataset::FileFormat::kPng ? dataset::ToSamples(pixels, encoding)
                                                      : dataset::Quantise(pixels, encoding);
}

// The drawn scale, or the least larger one by which the crop fits: a set of photographs has all sizes, and
// one that is large enough as it is shall not fail because a small scale was drawn.
double CleanFrames::FittingScale(cv::Size size) const {
  double scale = config_.source.scale;
  if (Holds(Scaled(size, scale), config_.size)) return scale;
  if (Holds(size, config_.size) && scale < 1)
    return std::min(1.0, std::max(static_cast<double>(config_.size.width) / size.width,
                                  static_cast<double>(config_.size.height) / size.height));
  throw std::runtime_error(sources_.items()[item_].string() + ": is " + SizeText(size) + " px" +
                           (scale == 1 ? "" : " (" + SizeText(Scaled(size, scale)) + " after source.scale)") +
                           ", smaller than the crop of " + SizeText(config_.size));
}

cv::Rect CleanFrames::ChooseCrop(cv::Size scaled) {
  const cv::Point spare(scaled.width - config_.size.width, scaled.height - config_.size.height);
  if (config_.source.crop == Crop::kCentre) return {cv::Point(spare.x / 2, spare.y / 2), config_.size};
  return {cv::Point(static_cast<int>(sim::DrawInteger(key_, "source.crop.x", 0, spare.x)),
                    static_cast<int>(sim::DrawInteger(key_, "source.crop.y", 0, spare.y))),
          config_.size};
}

}  // namespace shimmer::app
