// What a config says, as values: one struct a section. The keys are the Fields, the defaults what a new
// struct holds.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "sim/app/config/error.h"
#include "sim/app/config/object_params.h"
#include "sim/app/config/source_params.h"
#include "sim/camera.h"
#include "sim/dataset/layout.h"
#include "sim/fields.h"
#include "sim/scene.h"
#include "sim/sensor.h"

namespace shimmer::app {

enum class Format { kPng, kExr };
enum class PngWriter { kIsal, kOpenImageIo };
using dataset::LayoutKind;

struct OutputParams {
  Format format = Format::kPng;
  int bits = 8;  // png: 8 or 16; exr: 16 (half) or 32 (float)
  PngWriter png_writer = PngWriter::kIsal;
  LayoutKind layout = LayoutKind::kSequence;
  std::vector<std::string> truth;  // any of "tilt", "sigma", "mask", "flow", "shake"
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
                .names = {"tilt", "sigma", "mask", "flow", "shake"},
                .help = "what is known of each frame, written beside it: the turbulence's shifts and sigmas; "
                        "the moving objects' coverage and motion in the steady frame; the camera's shake",
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
  sim::CameraParams camera;
  std::vector<ObjectParams> objects;
  sim::SensorParams sensor;
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
    visit.Section("camera", "its shake", self.camera);
    visit.List("objects", 64, "what moves over the scene, from the farthest to the nearest", self.objects);
    visit.Section("sensor", "noise and compression of the turbulent frames; the clean ones have none",
                  self.sensor);
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
