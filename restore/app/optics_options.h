// The camera's optics as a person gives them on the command line, and Cn2 as it follows from them.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "restore/turbulence_strength.h"

namespace shimmer::restore::app {

struct OpticsOptions {
  std::optional<double> pixel_rad, aperture_m, distance_m;  // all three, or none
  std::optional<Tilt> tilt;
  std::optional<bool> point_source;
};

void AddOpticsOptions(CLI::App& command, OpticsOptions& options);

// None where none was given. Throws std::invalid_argument where some are missing, or are not above 0.
std::optional<Optics> OpticsOf(const OpticsOptions& options);

// "edge", "grad" or "plane"; as they are given.
const char* TiltName(Tilt tilt);

}  // namespace shimmer::restore::app
