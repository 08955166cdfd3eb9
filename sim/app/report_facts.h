// What the lines of a data set's manifest say all together: what its report shows.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/app/config/config.h"
#include "sim/dataset/dataset_reader.h"

namespace shimmer::app {

// One value of every clip that is done: numbers, or how often each of other values is there, by its text
// ("star", "96x64"). None of a clip that doesn't say it.
struct Values {
  std::vector<double> numbers;  // finite, ascending
  std::map<std::string, int64_t> others;

  void Add(const Json& value);
};

// "star", "96x64", "0.5".
std::string ValueText(const Json& value);

struct Failure {
  int64_t clips = 0;
  std::vector<int64_t> first_clips;  // up to kFirstClips of them, ascending
};
inline constexpr size_t kFirstClips = 20;

struct ReportFacts {
  std::map<std::string, Values> drawn;  // by key ("tilt.strength_px")
  Values tilt_rms_px, mean_sigma_px;
  Values shake_rms_px, moving_share;               // of clips whose camera shakes, and that have masks
  std::map<std::string, int64_t> clips_of_source;  // by path; none of drawn scenes
  std::map<std::string, Failure> failures;         // by error
  uint64_t file_bytes = 0;                         // of the clips' files; 0 where the lines don't say
};

// The records of dataset.json's sources, by what they are of.
struct SourceCounts {
  int64_t backgrounds = 0, masks_and_objects = 0;
};
SourceCounts CountSources(const Json& sources);

// Reads every line once, and keeps of it no more than the numbers above. Throws std::runtime_error.
ReportFacts FactsOf(const dataset::DatasetReader& reader);

}  // namespace shimmer::app
