// A value that is drawn for each clip:
//   {"uniform": [a, b]}  {"log_uniform": [a, b]}  {"normal": [mean, sd], "clip": [a, b]}
//   {"choice": [...], "weights": [...]}
// Any of them may have "as": "label" beside it: it is drawn by the label's hash instead of by its own path's,
// so that keys of one label are drawn alike (the same place among as many choices, the same share of a
// range). Keys of whole numbers draw whole numbers, a and b among them. Keys of anything else, and of a
// closed list of numbers, take "choice" alone.
#pragma once

#include <array>
#include <string>

#include "sim/app/config/keys.h"
#include "sim/draw.h"

namespace shimmer::app {

inline constexpr const char* kUniform = "uniform";
inline constexpr const char* kLogUniform = "log_uniform";
inline constexpr const char* kNormal = "normal";
inline constexpr const char* kClip = "clip";
inline constexpr const char* kChoice = "choice";
inline constexpr const char* kWeights = "weights";
inline constexpr const char* kAs = "as";

struct DistributionForm {
  const char* name;
  const char* companion;  // the key that may stand beside it; or empty
  const char* example;
  const char* help;
};
inline constexpr std::array<DistributionForm, 4> kDistributionForms = {{
    {kUniform, "", R"({"uniform": [a, b]})", "from a to b, both included; whole numbers where the key's are"},
    {kLogUniform, "", R"({"log_uniform": [a, b]})",
     "likewise, each factor of 2 as likely as any other; 0 < a"},
    {kNormal, kClip, R"({"normal": [mean, sd], "clip": [a, b]})",
     "cut to [a, b]; without clip to the key's range"},
    {kChoice, kWeights, R"({"choice": [...], "weights": [...]})",
     "any of the values; without weights each as likely"},
}};

// Whether a key takes more than "choice".
bool DrawsNumbers(const Key& key);

// The distribution with every number of the key's kind and with "clip" or "weights" filled in (the key's
// range; equal weights). All that it may draw lies in the key's range. Throws ConfigError with the pointer of
// what is wrong in it. pointer: where the distribution stands.
Json CheckedDistribution(const Key& key, const Json& distribution, const std::string& pointer);

// The least and the greatest that a checked number or distribution of numbers may be.
struct Support {
  double low, high;
};
Support SupportOf(const Json& value);

// The greatest of them.
double LargestOf(const Json& value);

// The greatest width and the greatest height of a checked size, or choice of sizes.
cv::Size LargestSizeOf(const Json& value);

// Whether a checked value, drawn or not, may be this name.
bool MayBe(const Json& value, const std::string& name);

// One value, by the clip and the key's path alone. distribution: checked.
Json DrawFrom(const Key& key, const Json& distribution, sim::ClipKey clip);

}  // namespace shimmer::app
