// Config list `objects`: what moves over the scene. What each looks like is exactly one of drawn, images,
// video and sequence; of images, videos and sequences a clip draws one.
#pragma once

#include <string>
#include <vector>

#include "sim/app/config/source_params.h"
#include "sim/motion.h"

namespace shimmer::app {

struct ObjectParams : FilePatterns {
  std::string drawn;  // a shape of sim/shapes.h, or "text"; empty: none
  std::string text = "SHIMMER";
  double chance = 1;
  bool present = true;  // drawn for each clip by its chance
  double height_px = 60;
  double hue = 0, saturation = 0.7, brightness = 0.8;
  double shutter = 0;
  double distance = 1;
  sim::MotionParams motion;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "drawn",
                .names = {"box", "disc", "walker", "text"},
                .help = "an object that needs no data: a car of boxes, a ball, a walking figure, letters",
                .alternative = true},
          self.drawn);
    FilePatterns::Fields(self, visit);
    visit(Field{.name = "text", .low = 1, .high = 100, .help = "drawn text: what it says"}, self.text);
    visit(Field{.name = "chance", .low = 0, .high = 1, .help = "the share of the clips that it is in"},
          self.chance);
    visit(Field{.name = "height_px", .unit = "px", .low = 1, .high = 8192, .help = "in the first frame"},
          self.height_px);
    visit(Field{.name = "hue", .low = 0, .high = 1, .help = "of what is drawn: 0 red, 1/3 green, 2/3 blue"},
          self.hue);
    visit(Field{.name = "saturation", .low = 0, .high = 1, .help = "of what is drawn"}, self.saturation);
    visit(Field{.name = "brightness", .low = 0, .high = 1, .help = "of what is drawn"}, self.brightness);
    visit(Field{.name = "shutter",
                .low = 0,
                .high = 1,
                .help = "motion blur: the share of a frame's time that the shutter is open. 0 means none"},
          self.shutter);
    visit(
        Field{.name = "distance",
              .low = 0,
              .high = 1,
              .help =
                  "strength of the turbulence where it is seen, relative to the background's: what is nearer "
                  "is distorted less"},
        self.distance);
    visit.Section("motion", "its path, size and angle over time", self.motion);
  }
};

}  // namespace shimmer::app
