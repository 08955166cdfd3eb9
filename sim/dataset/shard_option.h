// --shard i/N, or --shard slurm
#pragma once

#include <string>

#include "sim/dataset/shard.h"

namespace shimmer::dataset {

// "3/8": shard 3 of 0 .. 7. "slurm": by this task's number in its job array, whatever number the array begins
// with and whatever step it has. Throws std::invalid_argument for anything else, and for "slurm" outside of a
// job array.
Shard ShardOf(const std::string& text);

}  // namespace shimmer::dataset
