#include "sim/dataset/compression.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

#include "sim/dataset/image_io.h"

namespace shimmer::dataset {
namespace {

// FFmpeg, and x264 through it, talk on stderr, and libraries must not print. Set before main, where there is
// one thread. (Whoever sets OPENCV_FFMPEG_LOGLEVEL hears them again as soon as a video is opened: video.cpp.)
const bool kFfmpegIsQuiet = (av_log_set_level(AV_LOG_QUIET), true);

// A key frame at least every two seconds, as cameras do.
constexpr int kKeyFrameEvery = 50;
constexpr AVRational kFrameTime_s = {1, 25};
constexpr int kMinCodedSide_px = 16;  // one macroblock: H.264 codes no less
constexpr uint8_t kNoColour = 128;

// Exact arithmetic, in which no CPU's SIMD differs from plain C; colour is interpolated between its samples.
// Not bilinear: libswscale then takes the wrong rows' means, and colour moves down by half a pixel.
constexpr int kConversion =
    SWS_BICUBIC | SWS_BITEXACT | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP | SWS_FULL_CHR_H_INT;

struct Freed {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* converter) const { sws_freeContext(converter); }
};
template <class T>
using Holder = std::unique_ptr<T, Freed>;

void Require(int result, const char* what) {
  if (result >= 0) return;
  char why[AV_ERROR_MAX_STRING_SIZE] = "";
  av_strerror(result, why, sizeof why);
  throw std::runtime_error(std::string("H.264: ") + what + ": " + why);
}

template <class T>
Holder<T> Allocated(T* allocated) {
  if (!allocated) throw std::bad_alloc();
  return Holder<T>(allocated);
}

Holder<AVFrame> NewFrame(cv::Size size, AVPixelFormat format) {
  auto frame = Allocated(av_frame_alloc());
  frame->width = size.width;
  frame->height = size.height;
  frame->format = format;
  Require(av_frame_get_buffer(frame.get(), 0), "no memory for a frame");
  return frame;
}

cv::Mat PlaneOf(const AVFrame& frame, int type) {
  return cv::Mat(frame.height, frame.width, type, frame.data[0], frame.linesize[0]);
}

std::string SizeText(cv::Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

std::string KindOf(int type, cv::Size size) { return cv::typeToString(type) + " " + SizeText(size); }

void Check(cv::Size size, int channels, double crf) {
  const auto within = [](int side) { return side >= 1 && side <= kMaxH264Side_px; };
  if (!within(size.width) || !within(size.height))
    throw std::invalid_argument("size = " + SizeText(size) + " px, must be 1 to " +
                                std::to_string(kMaxH264Side_px) + " each way");
  if (channels != 1 && channels != 3)
    throw std::invalid_argument("channels = " + std::to_string(channels) + ", must be 1 or 3");
  if (!(crf >= 0 && crf <= 51))
    throw std::invalid_argument("crf = " + std::to_string(crf) + ", must be in [0, 51]");
}

// 4:2:0 has colour for every second row and column.
cv::Size CodedSize(cv::Size size) {
  const auto coded = [](int side) { return std::max(kMinCodedSide_px, side + side % 2); };
  return {coded(size.width), coded(size.height)};
}

Holder<AVCodecContext> OpenEncoder(cv::Size size, int channels, double crf) {
  const AVCodec* const codec = avcodec_find_encoder_by_name("libx264");
  if (!codec) throw std::runtime_error("H.264: this FFmpeg (libavcodec) has no encoder libx264");
  auto encoder = Allocated(avcodec_alloc_context3(codec));
  encoder->width = size.width;
  encoder->height = size.height;
  encoder->pix_fmt = AV_PIX_FMT_YUV420P;
  encoder->color_range = channels == 1 ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
  encoder->colorspace = AVCOL_SPC_BT709;
  encoder->time_base = kFrameTime_s;
  encoder->gop_size = kKeyFrameEvery;
  encoder->thread_count = 1;
  const auto set = [&](const char* name, const char* value) {
    Require(av_opt_set(encoder->priv_data, name, value, 0), name);
  };
  set("preset", "veryfast");
  set("tune", "zerolatency");               // no frame waits for later ones
  set("x264-params", "cpu-independent=1");  // or else its SIMD gives other bits than its C
  Require(av_opt_set_double(encoder->priv_data, "crf", crf, 0), "crf");
  Require(avcodec_open2(encoder.get(), codec, nullptr), "the encoder libx264 can't be opened");
  return encoder;
}

Holder<AVCodecContext> OpenDecoder() {
  const AVCodec* const codec = avcodec_find_decoder(AV_CODEC_ID_H264);
  if (!codec) throw std::runtime_error("H.264: this FFmpeg (libavcodec) has no decoder of H.264");
  auto decoder = Allocated(avcodec_alloc_context3(codec));
  decoder->thread_count = 1;
  decoder->flags |= AV_CODEC_FLAG_LOW_DELAY;
  Require(avcodec_open2(decoder.get(), codec, nullptr), "the decoder can't be opened");
  return decoder;
}

Holder<SwsContext> Converter(cv::Size size, AVPixelFormat from, AVPixelFormat to) {
  Holder<SwsContext> converter(sws_getContext(size.width, size.height, from, size.width, size.height, to,
                                              kConversion, nullptr, nullptr, nullptr));
  if (!converter) throw std::runtime_error("H.264: libswscale can't convert between RGB and YUV 4:2:0");
  const int* const bt709 = sws_getCoefficients(SWS_CS_ITU709);
  const int from_full = from == AV_PIX_FMT_RGB24, to_full = to == AV_PIX_FMT_RGB24;
  Require(sws_setColorspaceDetails(converter.get(), bt709, from_full, bt709, to_full, 0, 1 << 16, 1 << 16),
          "libswscale can't do BT.709");
  return converter;
}

void Convert(SwsContext* converter, const AVFrame& from, AVFrame& to) {
  Require(sws_scale(converter, from.data, from.linesize, 0, from.height, to.data, to.linesize),
          "colours can't be converted");
}

}  // namespace

cv::Mat ThroughJpeg(const cv::Mat& frame, int quality) {
  return ReadSamples("frame.jpg", EncodeJpeg(frame, quality, JpegColour::kHalved)).pixels;
}

struct H264Stream::Codecs {
  Codecs(cv::Size frame_size, int channels, double crf)
      : size(frame_size),
        type(CV_8UC(channels)),
        coded_size(CodedSize(frame_size)),
        encoder(OpenEncoder(coded_size, channels, crf)),
        yuv(NewFrame(coded_size, AV_PIX_FMT_YUV420P)) {
    if (channels == 3) {
      rgb = NewFrame(coded_size, AV_PIX_FMT_RGB24);
      to_yuv = Converter(coded_size, AV_PIX_FMT_RGB24, AV_PIX_FMT_YUV420P);
      to_rgb = Converter(coded_size, AV_PIX_FMT_YUV420P, AV_PIX_FMT_RGB24);
    } else {
      for (const int plane : {1, 2})
        std::fill_n(yuv->data[plane], yuv->linesize[plane] * coded_size.height / 2, kNoColour);
    }
  }

  // Into yuv, with the last row and column repeated up to the coded size.
  void Take(const cv::Mat& frame) {
    Require(av_frame_make_writable(yuv.get()), "no memory for a frame");
    cv::Mat plane = PlaneOf(rgb ? *rgb : *yuv, type);
    cv::copyMakeBorder(frame, plane, 0, coded_size.height - size.height, 0, coded_size.width - size.width,
                       cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
    if (rgb) Convert(to_yuv.get(), *rgb, *yuv);
    yuv->pts = next_frame++;
  }

  // Neither waits for more than the one frame: what comes out is what has gone in.
  void EncodeAndDecode() {
    Require(avcodec_send_frame(encoder.get(), yuv.get()), "a frame can't be encoded");
    Require(avcodec_receive_packet(encoder.get(), packet.get()), "a frame can't be encoded");
    Require(avcodec_send_packet(decoder.get(), packet.get()), "a frame can't be decoded");
    av_packet_unref(packet.get());
    Require(avcodec_receive_frame(decoder.get(), decoded.get()), "a frame can't be decoded");
    if (decoded->width != coded_size.width || decoded->height != coded_size.height ||
        decoded->pts != yuv->pts)
      throw std::runtime_error("H.264: another frame was decoded than encoded");
  }

  cv::Mat Give() {
    if (rgb) Convert(to_rgb.get(), *decoded, *rgb);
    return PlaneOf(rgb ? *rgb : *decoded, type)(cv::Rect({0, 0}, size)).clone();
  }

  const cv::Size size;
  const int type;
  const cv::Size coded_size;
  const Holder<AVCodecContext> encoder, decoder = OpenDecoder();
  const Holder<AVPacket> packet = Allocated(av_packet_alloc());
  const Holder<AVFrame> yuv, decoded = Allocated(av_frame_alloc());
  Holder<AVFrame> rgb;  // these three only where there is colour
  Holder<SwsContext> to_yuv, to_rgb;
  int64_t next_frame = 0;
};

H264Stream::H264Stream(cv::Size size, int channels, double crf) {
  Check(size, channels, crf);
  codecs_ = std::make_unique<Codecs>(size, channels, crf);
}

H264Stream::~H264Stream() = default;

cv::Mat H264Stream::Through(const cv::Mat& frame) {
  if (frame.type() != codecs_->type || frame.size() != codecs_->size)
    throw std::invalid_argument("frame = " + KindOf(frame.type(), frame.size()) + " px, must be " +
                                KindOf(codecs_->type, codecs_->size) + " px");
  codecs_->Take(frame);
  codecs_->EncodeAndDecode();
  return codecs_->Give();
}

}  // namespace shimmer::dataset
