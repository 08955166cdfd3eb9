#include "sim/app/plan_text.h"

#include <map>
#include <type_traits>

namespace shimmer::app {
namespace {

using sim::NumberText;

// "full", "dropped", "tile 256 px", "grid 8 px", "grid 8 px, every 4 frames"
std::string WayText(const noise::OctaveWay& way) {
  const auto px = [](int size) { return std::to_string(size) + " px"; };
  switch (way.kind) {
    case noise::OctaveWayKind::kFull:
      return "full";
    case noise::OctaveWayKind::kDropped:
      return "dropped";
    case noise::OctaveWayKind::kTiled:
      return "tile " + px(way.period_px);
    default:
      return "grid " + px(way.spacing_px) +
             (way.key_frames > 1 ? ", every " + std::to_string(way.key_frames) + " frames" : "");
  }
}

Json FieldJson(const noise::FieldPlan& field) {
  Json octaves = Json::array();
  for (const noise::OctaveWay& way : field.octaves) octaves.push_back(WayText(way));
  return {{"octaves", octaves}, {"max_error", field.max_error}, {"rms_error", field.rms_error}};
}

// A struct with Fields, as a JSON object.
class ToJson {
 public:
  template <class Value>
  void operator()(const Field& field, const Value& value) {
    if constexpr (std::is_enum_v<Value>)
      object[field.name] = field.names.at(static_cast<size_t>(value));
    else if constexpr (std::is_same_v<Value, noise::FieldPlan>)
      object[field.name] = FieldJson(value);
    else
      object[field.name] = value;
  }
  Json object = Json::object();
};

template <class Part>
Json PartJson(const std::optional<Part>& part) {
  if (!part) return nullptr;
  ToJson json;
  Part::Fields(*part, json);
  return json.object;
}

std::string Px(int px) { return std::to_string(px) + " px"; }

// "tilt, octaves 5, 6: all but one tile of 256 px, which repeats exactly"
void AddOctaves(const std::string& field, const noise::FieldPlan& plan, std::vector<std::string>& lines) {
  std::map<std::string, std::string> octaves_by_what;
  for (size_t i = 0; i < plan.octaves.size(); ++i) {
    const noise::OctaveWay& way = plan.octaves[i];
    std::string what;
    if (way.kind == noise::OctaveWayKind::kDropped)
      what = "below the budget";
    else if (way.kind == noise::OctaveWayKind::kTiled)
      what = "all but one tile of " + Px(way.period_px) + ", which repeats exactly";
    else if (way.spacing_px > 1)
      what = "all but one pixel in " + std::to_string(way.spacing_px) +
             " along each axis, with a spline between";
    if (way.key_frames > 1)
      what += std::string(what.empty() ? "" : ", and ") + "all but one frame in " +
              std::to_string(way.key_frames) + ", with a cubic between";
    if (!what.empty()) octaves_by_what[what] += ", " + std::to_string(i);
  }
  for (const auto& [what, octaves] : octaves_by_what)
    lines.push_back(field + ", octave " + octaves.substr(2) + ": " + what);
}

void AddTilt(const sim::ClipPlan& plan, std::vector<std::string>& lines) {
  if (!plan.tilt) {
    lines.push_back("tilt: tilt.strength_px is 0");
    return;
  }
  if (plan.tilt->frozen) lines.push_back("tilt, all frames but one: tilt.temporal_scale is 0");
  AddOctaves("tilt", plan.tilt->field, lines);
}

void AddBlur(const Config& config, const sim::ClipPlan& plan, std::vector<std::string>& lines) {
  if (!plan.blur) {
    const double sigma_px = config.blur.max_sigma_px;
    lines.push_back(sigma_px > 0 ? "blur: sigma up to " + NumberText(sigma_px) + " px can't be seen"
                                 : "blur: blur.max_sigma_px is 0");
    return;
  }
  const sim::BlurPlan& blur = *plan.blur;
  const bool varies = config.blur.max_sigma_px > config.blur.min_sigma_px;
  if (blur.constant)
    lines.push_back("sigma map: one sigma everywhere");
  else if (!varies)
    lines.push_back("sigma map, Perlin and tilt part: one sigma, but for the objects' distance");
  else if (!blur.noise)
    lines.push_back("sigma map, Perlin part: blur.tilt_weight is 1");
  else if (!blur.tilt)
    lines.push_back("sigma map, tilt part: blur.tilt_weight is 0, or there is no tilt");
  if (blur.frozen) lines.push_back("sigma map, all frames but one: nothing moves it");
  if (blur.noise) AddOctaves("sigma map", blur.field, lines);
  if (blur.way == sim::BlurWay::kLadder)
    lines.push_back("blur, levels that no sigma of a block of 64 px asks for");
}

Json CompressionName(sim::Compression compression) {
  return compression == sim::Compression::kNone   ? Json()
         : compression == sim::Compression::kJpeg ? Json("jpeg")
                                                  : Json("h264");
}

}  // namespace

Json PlanJson(const sim::ClipPlan& plan) {
  return {{"tilt", PartJson(plan.tilt)},
          {"blur", PartJson(plan.blur)},
          {"linear_light", plan.linear_light},
          {"shake", PartJson(plan.shake)},
          {"objects", plan.objects},
          {"own_distances", plan.own_distances},
          {"sensor", plan.sensor},
          {"compression", CompressionName(plan.compression)},
          {"read_once", plan.read_once},
          {"render_once", plan.render_once},
          {"halo_px", plan.halo_px}};
}

std::vector<std::string> SkippedLines(const Config& config, const sim::ClipPlan& plan) {
  std::vector<std::string> lines;
  AddTilt(plan, lines);
  AddBlur(config, plan, lines);
  if (!plan.shake) lines.push_back("shake: the camera stands, nothing is resampled for it");
  if (plan.objects == 0) lines.push_back("objects: none moves, nothing is composed");
  if (plan.objects > 0 && plan.read_once)
    lines.push_back(
        "composing and preparing, all but what an object covers or has left: the background stands");
  if (plan.objects > 0 && !plan.own_distances)
    lines.push_back("strength of the turbulence by objects: all have the background's distance");
  if (!plan.sensor) lines.push_back("sensor: nothing of it is on");
  if (plan.compression == sim::Compression::kNone) lines.push_back("compression: sensor.compression is none");
  if (plan.render_once) lines.push_back("rendering, all frames but one: nothing moves");
  if (plan.read_once) lines.push_back("source, all frames but one: it is a still, decoded once");
  lines.push_back("frames before " + std::to_string(config.first_frame) + " and after " +
                  std::to_string(config.first_frame + config.frames - 1));
  if (plan.shape.frames < config.frames)
    lines.push_back("all but " + std::to_string(plan.shape.frames) + " of " + std::to_string(config.frames) +
                    " frames: pairs keep no more");
  lines.push_back("source further than " + Px(plan.AroundPx()) + " from the crop");
  std::string alike = "source, where it has it: alpha";  // objects have colours, and so has a sensor's noise
  if (plan.objects == 0 && !plan.sensor) alike += "; two of three equal channels";
  if (!plan.sensor) alike += "; tilt and blur of regions of one colour";
  lines.push_back(alike);
  return lines;
}

}  // namespace shimmer::app
