// Means over the clips of an evaluation, and how sure they are.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {

struct MeanOfClips {
  double mean = 0;
  std::optional<double> margin;  // half of the 95 % confidence interval (Student's t); absent of one clip
  int clips = 0;
};
// Of those that are there; absent where none is.
std::optional<MeanOfClips> MeanOf(std::span<const Value> values);

// Clips that have something in common: "all"; "strength" weak, medium or strong; "shake" yes or no; "objects"
// 0, 1, 2, 3. Only groups that have clips, in that order.
struct ClipGroup {
  std::string key, value;  // "all" has the value ""
  std::vector<const ClipResult*> clips;
};
std::vector<ClipGroup> GroupsOf(const std::vector<ClipResult>& clips);

// gain: less the input's, clip by clip.
std::optional<MeanOfClips> MeanIn(const ClipGroup& group, const std::string& variant,
                                  const std::string& stage, Measure measure, bool gain);

// Spearman's, with the mean rank for equals. Absent for fewer than 3 pairs, or where all of one are equal.
std::optional<double> RankCorrelation(std::span<const double> a, std::span<const double> b);

// Of the tilt that was found (of kFullName's look) and the true one, over the clips that have both.
std::optional<double> TiltCorrelation(const std::vector<ClipResult>& clips);

}  // namespace shimmer::restore::app
