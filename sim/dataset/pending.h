// Which clips of a data set are still to be made.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "sim/dataset/layout.h"
#include "sim/dataset/shard.h"

namespace shimmer::dataset {

struct Wanted {
  int64_t clips = 0;  // of the config: 0 .. clips - 1
  Shard shard = {};
  bool retry_failed = false;       // clips that failed once too
  std::vector<int64_t> only = {};  // not empty: these, failed ones too, with what stands in a tar with them
};

// One past the last clip of a unit: of the config's clips, and of those that an earlier run has made, whose
// `clips` may have been larger.
int64_t UnitEnd(const Layout& layout, int64_t unit, int64_t clips, const std::set<int64_t>& done,
                const std::set<int64_t>& failed);

// In ascending order. Clips that stand in one tar are all pending or none.
std::vector<int64_t> PendingClips(const Layout& layout, const Wanted& wanted, const std::set<int64_t>& done,
                                  const std::set<int64_t>& failed);

}  // namespace shimmer::dataset
