// What a sensor makes of the light that reaches it: a veil, photon noise, read noise, quantisation. In this
// order, each off by default. Compression comes after them, when the frame is whole (sim/app).
#pragma once

#include <cstdint>
#include <span>

#include "sim/draw.h"
#include "sim/fields.h"

namespace shimmer::sim {

enum class Compression { kNone, kJpeg, kH264 };

struct SensorParams {
  double veil = 0;
  double veil_level = 0.8;
  double full_well = 0;
  double read_noise = 0;
  int bits = 0;
  Compression compression = Compression::kNone;
  int jpeg_quality = 60;
  double h264_crf = 28;

  bool Noisy() const { return full_well > 0 || read_noise > 0; }
  bool On() const { return veil > 0 || Noisy() || bits > 0; }

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(
        Field{
            .name = "veil",
            .low = 0,
            .high = 1,
            .help =
                "contrast that is lost to light scattered on the way: a sample becomes (1 - veil) of itself "
                "and veil of veil_level"},
        self.veil);
    visit(Field{.name = "veil_level", .low = 0, .high = 1, .help = "the veil's own brightness, 1 is white"},
          self.veil_level);
    visit(
        Field{.name = "full_well",
              .unit = "electrons",
              .low = 0,
              .high = 1e7,
              .help =
                  "photon (shot) noise: electrons that white is made of; a sample's variance is its own mean "
                  "number of electrons. 0 means none"},
        self.full_well);
    visit(Field{.name = "read_noise",
                .unit = "1/255",
                .low = 0,
                .high = 255,
                .help = "standard deviation of the noise that reading adds to every sample. 0 means none"},
          self.read_noise);
    visit(
        Field{
            .name = "bits",
            .low = 0,
            .high = 16,
            .help =
                "the sensor's own quantisation: samples become multiples of 1 / (2^bits - 1). 0 means none"},
        self.bits);
    visit(Field{.name = "compression",
                .names = {"none", "jpeg", "h264"},
                .help = "what the camera writes, decoded again: each frame a JPEG, or all of them an H.264 "
                        "stream; of 8 bits, colour at half the resolution"},
          self.compression);
    visit(Field{.name = "jpeg_quality", .low = 1, .high = 100, .help = "jpeg: 100 is the best"},
          self.jpeg_quality);
    visit(Field{.name = "h264_crf",
                .low = 0,
                .high = 51,
                .help = "h264: constant rate factor of x264; 0 is lossless, 23 its default, 51 the worst"},
          self.h264_crf);
  }
};

// A row of samples, 1 is white, of one channel, pixels x0 .. of row y in frame t: noise of a pixel is a
// function of (key, t, y, x, channel) alone. Results may lie outside [0, 1] by noise, as a sensor's do about
// black; quantisation cuts them to it. Photons: Poisson, normal from 64 electrons on (which has the same mean
// and variance); samples below 0 have none.
void SenseRow(const SensorParams& sensor, ClipKey key, int64_t t, int y, int channel, int x0,
              std::span<float> row);

}  // namespace shimmer::sim
