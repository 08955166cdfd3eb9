// Clips made several at a time, on all threads, and handed on in their order, so that what is written of them
// is the same however many threads there are.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "sim/app/job.h"
#include "sim/dataset/dataset_writer.h"

namespace shimmer::app {

struct MadeClip {
  int64_t clip;
  std::optional<dataset::StagedClip> staged;  // none: its source is bad, and error says what of it
  Json line;                                  // for the manifest
  std::string error;
};

struct PipelineLimits {
  int threads = 1;
  int clips_at_once = 1;  // in the making; fewer than threads where memory is short
};

// Makes these clips, each into writer.Stage(clip), and gives them to keep, one at a time. Ends early, with
// the clips that were kept by then, when stop is set. Throws what keep throws, TargetError, and
// std::runtime_error where memory runs out, when no clip is in hand any more.
void MakeClips(const Job& job, std::span<const int64_t> clips, const dataset::DatasetWriter& writer,
               PipelineLimits limits, const std::atomic<bool>& stop,
               const std::function<void(MadeClip)>& keep);

// The same, and all that keep has given to the writer is durable when it returns or throws: what is finished
// stays, whatever ended it.
void MakeClipsDurably(const Job& job, std::span<const int64_t> clips, dataset::DatasetWriter& writer,
                      PipelineLimits limits, const std::atomic<bool>& stop,
                      const std::function<void(MadeClip)>& keep);

}  // namespace shimmer::app
