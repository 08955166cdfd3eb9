// What the config tests share: small configs, and the error of a bad one as one text.
#pragma once

#include <string>
#include <vector>

#include "sim/app/config/config.h"

namespace shimmer::app {

// {"source": {"drawn": "chart"}, REST}: a config that is complete but for REST.
inline std::string WithSource(const std::string& rest = "") {
  return R"({"source": {"drawn": "chart"})" + (rest.empty() ? "" : ", " + rest) + "}";
}

// "POINTER: message"; "no error" if the config is good.
inline std::string ErrorOf(const std::string& text, const std::vector<std::string>& sets = {}) {
  try {
    ConfigFile::Parse(text, sets);
    return "no error";
  } catch (const ConfigError& error) {
    return error.pointer() + ": " + error.what();
  }
}

// Every key of the config's contract, none with its default, most of them drawn.
inline constexpr const char* kFullConfig = R"({
  "seed": 7, "clips": 100000, "frames": 24, "size": {"choice": [[256, 256], [320, 200]], "weights": [3, 1]},
  "first_frame": 5,
  "source": {"images": ["photos/**/*.jpg", "more"], "scale": {"uniform": [0.5, 1]}, "crop": "centre", "flip": true,
             "start": "first"},
  "tilt": {"strength_px": {"uniform": [1, 10]}, "base_frequency": {"log_uniform": [0.015, 0.06]},
           "octaves": {"uniform": [3, 8]}, "lacunarity": {"normal": [2, 0.1], "clip": [1.5, 2.5]}, "persistence": 0.45,
           "temporal_scale": {"normal": [1, 2]}, "lattice": {"choice": ["seeded", "classic"]},
           "kernel": {"choice": [0.5, 0.6]}, "interpolation": "bilinear"},
  "blur": {"min_sigma_px": {"uniform": [0, 0.5]}, "max_sigma_px": {"uniform": [0.5, 6]}, "base_frequency": 0.02,
           "octaves": {"normal": [9, 2], "clip": [7, 11]}, "lacunarity": 2.5, "persistence": 0.4,
           "tilt_weight": {"uniform": [0, 1]}, "temporal_scale": 1, "method": "stack", "level_choice": "nearest"},
  "camera": {}, "objects": [], "sensor": {},
  "colour": "linear",
  "accuracy": {"max_error_px": 0.1, "max_error_levels": 0},
  "output": {"format": "exr", "bits": 32, "layout": "pairs", "truth": ["tilt", "sigma"], "name": "night",
             "test_fraction": 0.1, "frames_per_clip": 3}
})";

}  // namespace shimmer::app
