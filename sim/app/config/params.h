// What a config says, as values: one struct a section. The keys are the Fields, the defaults what a new
// struct holds.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "sim/app/config/error.h"
#include "sim/dataset/layout.h"
#include "sim/drawn/drawn.h"
#include "sim/fields.h"
#include "sim/scene.h"

namespace shimmer::app {

using sim::Field;

enum class Crop { kRandom, kCentre };
enum class Start { kRandom, kFirst };
enum class Format { kPng, kExr };
enum class PngWriter { kIsal, kOpenImageIo };
using dataset::LayoutKind;

// Where clean frames come from: exactly one of images, video, sequence, drawn.
struct SourceParams {
  std::vector<std::string> images;    // folders, files or globs of stills
  std::vector<std::string> video;     // files or globs of videos
  std::vector<std::string> sequence;  // folders of numbered frames, or printf patterns (frame%04d.png)
  std::string drawn;                  // a scene of sim/drawn/drawn.h; empty: none
  double scale = 1;
  Crop crop = Crop::kRandom;
  bool flip = false;
  Start start = Start::kRandom;

  bool FromFiles() const { return !images.empty() || !video.empty() || !sequence.empty(); }

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "images",
                .low = 1,
                .help = "folder, file or glob of still images, or a list of them",
                .per_clip = false,
                .alternative = true},
          self.images);
    visit(Field{.name = "video",
                .low = 1,
                .help = "video file or glob, or a list of them",
                .per_clip = false,
                .alternative = true},
          self.video);
    visit(
        Field{
            .name = "sequence",
            .low = 1,
            .help =
                "folder of numbered frames, glob of such folders, or a pattern like frame%04d.png; or a list",
            .per_clip = false,
            .alternative = true},
        self.sequence);
    visit(Field{.name = "drawn",
                .names = {sim::kDrawnSceneNames.begin(), sim::kDrawnSceneNames.end()},
                .help = "a scene that needs no data",
                .alternative = true},
          self.drawn);
    visit(Field{.name = "scale",
                .low = 0.01,
                .high = 16,
                .help = "the source is resized by this before it is cropped"},
          self.scale);
    visit(Field{.name = "crop",
                .names = {"random", "centre"},
                .help = "where the crop lies in the source",
                .per_clip = false},
          self.crop);
    visit(Field{.name = "flip",
                .help = "mirror left to right: half of the clips, drawn by their hash",
                .per_clip = false},
          self.flip);
    visit(Field{.name = "start",
                .names = {"random", "first"},
                .help = "which frame of a video or sequence is frame 0",
                .per_clip = false},
          self.start);
  }
};

struct OutputParams {
  Format format = Format::kPng;
  int bits = 8;  // png: 8 or 16; exr: 16 (half) or 32 (float)
  PngWriter png_writer = PngWriter::kIsal;
  LayoutKind layout = LayoutKind::kSequence;
  std::vector<std::string> truth;  // any of "tilt", "sigma"
  std::string name = "shimmer";    // pairs, restormer: the folder that training code calls data_name
  double test_fraction = 0.02;     // pairs, restormer: share of the clips that go to NAME/test
  int frames_per_clip = 1;         // pairs, restormer: frames taken of each clip
  bool any_length = false;         // basicsr: clips of other than 100 frames
  int tar_mb = 256;                // webdataset: most MB of a tar

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "format",
                .names = {"png", "exr"},
                .help = "file format of the frames",
                .per_clip = false},
          self.format);
    visit(Field{.name = "bits",
                .low = 8,
                .high = 32,
                .values = {8, 16, 32},
                .help = "png: 8 or 16; exr: 16 (half) or 32 (float). Not given: png 8, exr 16",
                .per_clip = false},
          self.bits);
    visit(Field{.name = "png_writer",
                .names = {"isal", "openimageio"},
                .help = "isal: our own, five times as fast; openimageio: OpenImageIO's. Pixels are the same",
                .per_clip = false},
          self.png_writer);
    visit(Field{.name = "layout",
                .names = {"sequence", "pairs", "restormer", "basicsr", "webdataset"},
                .help = "tree of files (docs/formats.md)",
                .per_clip = false},
          self.layout);
    visit(Field{.name = "truth",
                .names = {"tilt", "sigma"},
                .help = "per-frame truth to write beside the frames",
                .per_clip = false},
          self.truth);
    visit(Field{.name = "name",
                .low = 1,
                .high = 100,
                .help = "layouts pairs, restormer: name of the set's folder",
                .per_clip = false},
          self.name);
    visit(Field{.name = "test_fraction",
                .low = 0,
                .high = 1,
                .help = "layouts pairs, restormer: share of the clips that go to test/",
                .per_clip = false},
          self.test_fraction);
    visit(Field{.name = "frames_per_clip",
                .low = 1,
                .high = 100000,
                .help = "layouts pairs, restormer: frames taken of each clip, evenly spread",
                .per_clip = false},
          self.frames_per_clip);
    visit(Field{.name = "any_length",
                .help = "layout basicsr: clips of other lengths than the 100 frames that its loader wants",
                .per_clip = false},
          self.any_length);
    visit(Field{.name = "tar_mb",
                .unit = "MB",
                .low = 1,
                .high = 1e6,
                .help = "layout webdataset: the most that a tar of more than one clip may hold",
                .per_clip = false},
          self.tar_mb);
  }
};

// Every value of one clip (each distribution drawn), and the values that hold for the whole set.
struct Config {
  uint64_t seed = 0;
  int64_t clips = 10;
  int frames = 16;
  cv::Size size{256, 256};
  int64_t first_frame = 0;
  SourceParams source;
  sim::TiltParams tilt;
  sim::BlurParams blur;
  sim::Colour colour = sim::Colour::kStored;
  sim::Accuracy accuracy;
  OutputParams output;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "seed",
                .low = 0,
                .high = 18446744073709551615.0,
                .help = "of every drawn value; any number, 0 too",
                .per_clip = false},
          self.seed);
    visit(Field{.name = "clips", .low = 1, .high = 1e9, .help = "number of clips", .per_clip = false},
          self.clips);
    visit(Field{.name = "frames",
                .unit = "frames",
                .low = 1,
                .high = 1e6,
                .help = "length of a clip",
                .per_clip = false},
          self.frames);
    visit(Field{.name = "size", .unit = "px", .low = 1, .high = 32768, .help = "width and height of a frame"},
          self.size);
    visit(
        Field{.name = "first_frame",
              .unit = "frames",
              .low = 0,
              .high = 2147483648.0,
              .help =
                  "time of a clip's first frame: the clip is frames first_frame .. first_frame + frames - 1",
              .per_clip = false},
        self.first_frame);
    visit.Section("source", "where clean frames come from: exactly one of images, video, sequence, drawn",
                  self.source);
    visit.Section("tilt", "shifts of the pixels", self.tilt);
    visit.Section("blur", "spatially varying Gaussian", self.blur);
    visit.Reserved("camera", Json::object(), "camera shake; has no keys yet");
    visit.Reserved("objects", Json::array(), "moving objects; none yet");
    visit.Reserved("sensor", Json::object(), "sensor noise; has no keys yet");
    visit(Field{.name = "colour",
                .names = {"stored", "linear"},
                .help = "stored: work on stored values as the paper does; linear: decode sRGB, work, encode",
                .per_clip = false},
          self.colour);
    visit.Section("accuracy", "what may be lost against the double reference", self.accuracy);
    visit.Section("output", "what is written", self.output);
  }
};

}  // namespace shimmer::app
