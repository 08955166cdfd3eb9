#include "sim/dataset/shard_option.h"

#include <charconv>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace shimmer::dataset {
namespace {

std::optional<int64_t> WholeNumber(std::string_view text) {
  int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return {};
  return number;
}

int64_t SlurmNumber(const char* name, std::optional<int64_t> otherwise = {}) {
  const char* text = std::getenv(name);
  const std::optional<int64_t> number = text ? WholeNumber(text) : otherwise;
  if (number) return *number;
  throw std::invalid_argument("--shard slurm: " + std::string(name) + " is " +
                              (text ? "'" + std::string(text) + "'" : "not set") +
                              ", must be a number; is this a task of a job array (sbatch --array=0-7)?");
}

Shard OfSlurmTask() {
  const int64_t id = SlurmNumber("SLURM_ARRAY_TASK_ID"), count = SlurmNumber("SLURM_ARRAY_TASK_COUNT"),
                first = SlurmNumber("SLURM_ARRAY_TASK_MIN", 0),
                step = SlurmNumber("SLURM_ARRAY_TASK_STEP", 1);
  const Shard shard{.index = step > 0 ? (id - first) / step : -1, .count = count};
  // An array of scattered numbers, "0,3,7", or one that was limited to some of them.
  if (shard.index < 0 || shard.index >= count || first + shard.index * step != id)
    throw std::invalid_argument(
        "--shard slurm: task " + std::to_string(id) + " of " + std::to_string(count) + " from " +
        std::to_string(first) +
        ", must be of an array of consecutive numbers; --shard i/N says it otherwise");
  return shard;
}

}  // namespace

Shard ShardOf(const std::string& text) {
  if (text == "slurm") return OfSlurmTask();
  const size_t slash = text.find('/');
  const auto index = WholeNumber(std::string_view(text).substr(0, slash));
  const auto count =
      slash == std::string::npos ? std::nullopt : WholeNumber(std::string_view(text).substr(slash + 1));
  if (!index || !count || *index < 0 || *index >= *count)
    throw std::invalid_argument("--shard " + text + ": must be i/N with 0 <= i < N, or slurm");
  return {.index = *index, .count = *count};
}

}  // namespace shimmer::dataset
