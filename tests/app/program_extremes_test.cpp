// No value in its range gives a frame that is not one.
#include "tests/app/program.h"

namespace shimmer::app {
namespace {

// At the ends of every range: frames finite, shifts and sigmas within what the config says.
TEST(Program, KeepsItsBoundsAtTheEndsOfTheRanges) {
  struct Extreme {
    Json tilt, blur;
    Json more = Json::object();
  };
  const std::vector<Extreme> extremes = {
      {{{"strength_px", 64}, {"octaves", 1}},
       {{"max_sigma_px", 32}, {"min_sigma_px", 32}},
       {{"size", {3, 2}}}},
      {{{"strength_px", 64}, {"kernel", 0.5}}, {{"max_sigma_px", 8}}, {{"size", {1, 9}}}},
      {{{"base_frequency", 0.5},
        {"lacunarity", 4},
        {"octaves", 16},
        {"persistence", 1},
        {"temporal_scale", 1000}},
       {{"base_frequency", 0.5},
        {"lacunarity", 4},
        {"octaves", 16},
        {"persistence", 1},
        {"temporal_scale", 1000}},
       {{"first_frame", 2147483646}}},
      {{{"base_frequency", 1e-6}, {"lacunarity", 1}, {"persistence", 0}},
       {{"base_frequency", 1e-6}, {"lacunarity", 1}, {"persistence", 0}, {"tilt_weight", 0}},
       {{"seed", 18446744073709551615u}}},
      {{{"strength_px", 0}}, {{"tilt_weight", 1}, {"max_sigma_px", 3}}},
      {{{"strength_px", 1e-300}}, {{"max_sigma_px", 1e-300}}},
      {{{"strength_px", 1e-30}}, {{"max_sigma_px", 1}, {"tilt_weight", 1}}},
      {{{"lattice", "classic"}, {"octaves", 16}, {"lacunarity", 4}}, {{"method", "stack"}, {"octaves", 16}}}};
  for (size_t i = 0; i < extremes.size(); ++i) {
    const auto& [tilt, blur, more] = extremes[i];
    const TempFolder folder;
    Json changes = {
        {"tilt", tilt}, {"blur", blur}, {"output", {{"format", "exr"}, {"truth", {"tilt", "sigma"}}}}};
    changes.update(more);
    folder.Put("c.json", SmallConfig(changes));
    ExpectDone(Generate(folder, "c.json", "set", {"--clip", "0"}));
    const dataset::DatasetReader reader(folder / "set");
    const double strength_px =
        tilt.value("strength_px", 5.0) * (tilt.value("kernel", 0.6) == 0.5 ? 1.084 : 1);
    const double rounding = 1 + 1e-6;  // the bounds hold in double, truth is float
    for (const int64_t frame : {0, 1}) {
      // A cubic overshoots by at most a quarter of the picture's range on each axis.
      EXPECT_TRUE(cv::checkRange(reader.Turb(0, frame).pixels, true, nullptr, -0.6, 1.6)) << i;
      EXPECT_EQ(reader.Turb(0, frame).replaced, 0) << i;
      EXPECT_LE(cv::norm(reader.TruthTilt(0, frame).value(), cv::NORM_INF), strength_px * rounding) << i;
      EXPECT_TRUE(cv::checkRange(reader.TruthTilt(0, frame).value())) << i;
      EXPECT_TRUE(cv::checkRange(reader.TruthSigma(0, frame).value())) << i;
      double low, high;
      cv::minMaxLoc(reader.TruthSigma(0, frame).value(), &low, &high);
      EXPECT_GE(low, blur.value("min_sigma_px", 0.0) / rounding) << i;
      EXPECT_LE(high, blur.value("max_sigma_px", 3.0) * rounding) << i;
    }
  }
}

}  // namespace
}  // namespace shimmer::app
