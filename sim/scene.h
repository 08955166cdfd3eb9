// What a turbulent clip is made of: the parameters of the model (docs/model.md), one struct a part.
// Each struct is a value with its defaults, declares its fields once, and checks itself.
#pragma once

#include "noise/simplex.h"
#include "sim/camera.h"
#include "sim/fields.h"
#include "sim/sensor.h"

namespace shimmer::sim {

enum class LatticeKind { kSeeded, kClassic };
enum class Interpolation { kNearest, kBilinear, kBicubic };
enum class BlurMethod { kAuto, kExact, kStack };
enum class LevelChoice { kNearest, kLinear };
enum class Colour { kStored, kLinear };

// Tilt: where each output pixel takes its light from. Shift along axis a of pixel (x, y) in frame t, in px:
//   d_a = S / A * sum_{i < K} p^i n_{a,i}(l^i (f x, f y, f v t) + o_{a,i}),   A = sum_{i < K} p^i,
// n 3-D simplex noise (paper eq. 5, with the amplitudes of the authors' own simulator).
struct TiltParams {
  double strength_px = 5;  // S: |d_a| <= S (kernel 0.5: 1.084 S), RMS 0.247 S at K = 8, p = 0.5. 0: no tilt
  double base_frequency = 0.03;  // f of octave 0, lattice cells per px
  int octaves = 8;               // K
  double lacunarity = 2;         // l
  double persistence = 0.5;      // p
  double temporal_scale = 2;     // v: octave 0 moves by f v cells a frame. 0: frozen
  LatticeKind lattice = LatticeKind::kSeeded;
  double kernel = 0.6;  // squared radius of the simplex kernel
  Interpolation interpolation = Interpolation::kBicubic;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "strength_px",
                .unit = "px",
                .low = 0,
                .high = 64,
                .help = "S: the largest shift along an axis; its RMS is 0.247 S. 0 means no tilt"},
          self.strength_px);
    visit(Field{.name = "base_frequency",
                .unit = "cycles/px",
                .low = 1e-6,
                .high = 0.5,
                .help = "f: frequency of the slowest octave (paper: 0.015 to 0.06)"},
          self.base_frequency);
    visit(Field{.name = "octaves", .low = 1, .high = 16, .help = "K: number of octaves"}, self.octaves);
    visit(Field{.name = "lacunarity",
                .low = 1,
                .high = 4,
                .help = "l: frequency of an octave over that of the one before"},
          self.lacunarity);
    visit(Field{.name = "persistence",
                .low = 0,
                .high = 1,
                .help = "p: amplitude of an octave over that of the one before"},
          self.persistence);
    visit(Field{.name = "temporal_scale",
                .unit = "px/frame",
                .low = 0,
                .high = 1000,
                .help = "v: how far the field moves along its time axis in a frame, in px of the image. 0 "
                        "means frozen"},
          self.temporal_scale);
    visit(Field{.name = "lattice",
                .names = {"seeded", "classic"},
                .help = "seeded: each axis and octave has its own table and origin; classic: Perlin's table, "
                        "as snoise3"},
          self.lattice);
    visit(Field{.name = "kernel",
                .low = 0.5,
                .high = 0.6,
                .values = {0.5, 0.6},
                .help = "squared radius of the simplex kernel: 0.6 as snoise3 (small jumps), 0.5 continuous"},
          self.kernel);
    visit(Field{.name = "interpolation",
                .names = {"nearest", "bilinear", "bicubic"},
                .help = "how the clean frame is read between its pixels"},
          self.interpolation);
  }
  void Validate() const;  // throws std::invalid_argument
  const noise::SimplexKernel& Kernel() const;
  double BoundPx() const;  // on |d_a|
};

// Blur: each output pixel gathers the tilted frame with a Gaussian of its own sigma, in px:
//   sigma = sigma_min + (sigma_max - sigma_min) ((1 - w) perlin01 + w tilt01)      (maps: sim/sigma_map.h)
struct BlurParams {
  double min_sigma_px = 0;
  double max_sigma_px = 3;        // 0: no blur
  double base_frequency = 0.015;  // cells per px of octave 0
  int octaves = 11;
  double lacunarity = 2;
  double persistence = 0.5;
  double tilt_weight = 0.5;   // w
  double temporal_scale = 2;  // as of the tilt
  BlurMethod method = BlurMethod::kAuto;
  LevelChoice level_choice = LevelChoice::kLinear;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "min_sigma_px",
                .unit = "px",
                .low = 0,
                .high = 32,
                .help = "smallest sigma of the Gaussian"},
          self.min_sigma_px);
    visit(Field{.name = "max_sigma_px",
                .unit = "px",
                .low = 0,
                .high = 32,
                .help = "largest sigma of the Gaussian. 0 means no blur"},
          self.max_sigma_px);
    visit(Field{.name = "base_frequency",
                .unit = "cycles/px",
                .low = 1e-6,
                .high = 0.5,
                .help = "frequency of the sigma map's slowest octave"},
          self.base_frequency);
    visit(Field{.name = "octaves", .low = 1, .high = 16, .help = "number of octaves of the sigma map"},
          self.octaves);
    visit(Field{.name = "lacunarity",
                .low = 1,
                .high = 4,
                .help = "frequency of an octave over that of the one before"},
          self.lacunarity);
    visit(Field{.name = "persistence",
                .low = 0,
                .high = 1,
                .help = "amplitude of an octave over that of the one before"},
          self.persistence);
    visit(Field{.name = "tilt_weight",
                .low = 0,
                .high = 1,
                .help = "w: share of the tilt's magnitude in the sigma map; the rest is Perlin noise"},
          self.tilt_weight);
    visit(Field{.name = "temporal_scale",
                .unit = "px/frame",
                .low = 0,
                .high = 1000,
                .help = "how far the sigma map moves along its time axis in a frame. 0 means frozen"},
          self.temporal_scale);
    visit(Field{.name = "method",
                .names = {"auto", "exact", "stack"},
                .help = "exact: each pixel's own Gaussian; stack: 11 blurred copies, as the paper; auto: "
                        "within the budget"},
          self.method);
    visit(Field{.name = "level_choice",
                .names = {"nearest", "linear"},
                .help = "how the stack is read between its levels"},
          self.level_choice);
  }
  void Validate() const;  // throws std::invalid_argument
};

// The one accuracy knob: what may be lost against the double reference. 0 is exact.
struct Accuracy {
  double max_error_px = 0.05;     // of every pixel's displacement
  double max_error_levels = 0.2;  // RMS of blurring a natural image, in 1/255 of the range

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit(Field{.name = "max_error_px",
                .unit = "px",
                .low = 0,
                .high = 64,
                .help = "bound on the error of a pixel's shift. 0 means exact",
                .per_clip = false},
          self.max_error_px);
    visit(Field{.name = "max_error_levels",
                .unit = "1/255",
                .low = 0,
                .high = 255,
                .help = "bound on the RMS error of blurring, in 1/255 of the range. 0 means exact",
                .per_clip = false},
          self.max_error_levels);
  }
  void Validate() const;  // throws std::invalid_argument
};

// All that the simulation of a clip depends on, but for the clean frames themselves.
struct Scene {
  TiltParams tilt = {};
  BlurParams blur = {};
  bool still = true;  // the source is one image, not a video
  Colour colour = Colour::kStored;
  SensorParams sensor = {};  // works on the light that the turbulence works on
  CameraParams camera = {};
  int objects = 0;             // that move in front of it (sim/moving_scene.h)
  bool own_distances = false;  // one of them has other turbulence than the background

  void Validate() const;  // throws std::invalid_argument
};

}  // namespace shimmer::sim
