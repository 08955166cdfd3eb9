// Config section `source`: where clean frames come from.
#pragma once

#include <string>
#include <vector>

#include "sim/drawn/drawn.h"
#include "sim/fields.h"

namespace shimmer::app {

using sim::Field;

enum class Crop { kRandom, kCentre };
enum class Start { kRandom, kFirst };

// Of files that show something: at most one of images, video and sequence.
struct FilePatterns {
  std::vector<std::string> images;    // folders, files or globs of stills
  std::vector<std::string> video;     // files or globs of videos
  std::vector<std::string> sequence;  // folders of numbered frames, or printf patterns (frame%04d.png)
  std::vector<std::string> masks;     // of the videos or sequences: listed in their order, or named like them

  bool FromFiles() const { return !images.empty() || !video.empty() || !sequence.empty(); }

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "images",
                .low = 1,
                .help = "folder, file or glob of still images (of an object: with alpha), a .txt with one "
                        "such a line, or a list of these; a clip takes one",
                .per_clip = false,
                .alternative = true},
          self.images);
    visit(Field{.name = "video",
                .low = 1,
                .help = "video file or glob, a .txt with one such a line, or a list of these",
                .per_clip = false,
                .alternative = true},
          self.video);
    visit(Field{.name = "sequence",
                .low = 1,
                .help = "folder of numbered frames, glob of such folders, a pattern like frame%04d.png, a "
                        ".txt with one such a line, or a list of these",
                .per_clip = false,
                .alternative = true},
          self.sequence);
    visit(Field{.name = "masks",
                .help = "what moves in `video` or `sequence`, white: one for each, listed in their order or "
                        "named like them; output.truth `mask` shows it",
                .per_clip = false},
          self.masks);
  }
};

// Where clean frames come from: exactly one of images, video, sequence, drawn.
struct SourceParams : FilePatterns {
  std::string drawn;  // a scene of sim/drawn/drawn.h; empty: none
  double scale = 1;
  Crop crop = Crop::kRandom;
  bool flip = false;
  Start start = Start::kRandom;
  double mask_threshold = 0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    FilePatterns::Fields(self, visit);
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
    visit(Field{.name = "mask_threshold",
                .low = 0,
                .high = 1,
                .help = "masks: from this brightness on a pixel is covered, and below it is not; 0: its "
                        "brightness is its coverage",
                .per_clip = false},
          self.mask_threshold);
  }
};

}  // namespace shimmer::app
