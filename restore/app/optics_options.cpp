#include "restore/app/optics_options.h"

#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/listed.h"

namespace shimmer::restore::app {
namespace {

constexpr const char *kPixel = "--pixel-rad", *kAperture = "--aperture-m", *kDistance = "--distance-m";

std::string NumberText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace

void AddOpticsOptions(CLI::App& command, OpticsOptions& options) {
  command.add_option(
      kPixel, options.pixel_rad,
      "field of view of a px, radians: its pitch / focal length. With the next two Cn2 is found");
  command.add_option(kAperture, options.aperture_m, "diameter of the aperture, m");
  command.add_option(kDistance, options.distance_m, "from the camera to the scene, m");
  command
      .add_option("--tilt", options.tilt,
                  "which tilt Cn2 is taken from: plane, that of the plane that fits the wave best (default), "
                  "grad, its mean gradient, or edge, between opposite edges of the aperture")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Tilt>{
          {"edge", Tilt::kEdge}, {"grad", Tilt::kGrad}, {"plane", Tilt::kPlane}}));
  command
      .add_option(
          "--source", options.point_source,
          "point: light from points of the scene, at that distance (default); parallel: from far off, "
          "through so much air")
      ->transform(CLI::CheckedTransformer(std::map<std::string, bool>{{"point", true}, {"parallel", false}}));
}

std::optional<Optics> OpticsOf(const OpticsOptions& options) {
  const std::pair<const char*, std::optional<double>> numbers[] = {
      {kPixel, options.pixel_rad}, {kAperture, options.aperture_m}, {kDistance, options.distance_m}};
  std::vector<std::string> missing;
  for (const auto& [name, value] : numbers) {
    if (!value) missing.emplace_back(name);
    if (value && !(std::isfinite(*value) && *value > 0))
      throw std::invalid_argument(std::string(name) + " = " + NumberText(*value) + ", must be above 0");
  }
  if (missing.size() == std::size(numbers) && !options.tilt && !options.point_source) return {};
  if (!missing.empty())
    throw std::invalid_argument(cli::Listed(missing, "and") + (missing.size() == 1 ? " is" : " are") +
                                " missing: Cn2 needs field of view of a px, aperture and distance");
  return Optics{.pixel_rad = *options.pixel_rad,
                .aperture_m = *options.aperture_m,
                .distance_m = *options.distance_m,
                .tilt = options.tilt.value_or(Tilt::kPlane),
                .point_source = options.point_source.value_or(true)};
}

const char* TiltName(Tilt tilt) {
  return tilt == Tilt::kEdge ? "edge" : tilt == Tilt::kGrad ? "grad" : "plane";
}

}  // namespace shimmer::restore::app
