#include "sim/dataset/pending.h"

#include <algorithm>
#include <iterator>

namespace shimmer::dataset {

int64_t UnitEnd(const Layout& layout, int64_t unit, int64_t clips, const std::set<int64_t>& done,
                const std::set<int64_t>& failed) {
  const int64_t begin = unit * layout.ClipsPerUnit(), most = begin + layout.ClipsPerUnit();
  int64_t end = std::min(most, clips);
  for (const auto* known : {&done, &failed})
    if (const auto after = known->lower_bound(most); after != known->begin() && *std::prev(after) >= begin)
      end = std::max(end, *std::prev(after) + 1);
  return end;
}

std::vector<int64_t> PendingClips(const Layout& layout, const Wanted& wanted, const std::set<int64_t>& done,
                                  const std::set<int64_t>& failed) {
  const int64_t per_unit = layout.ClipsPerUnit();
  const bool failed_settles = !wanted.retry_failed && wanted.only.empty();
  std::vector<int64_t> pending;
  const auto add_unit = [&](int64_t unit) {
    if (!wanted.shard.Has(unit)) return;
    const int64_t begin = unit * per_unit, end = UnitEnd(layout, unit, wanted.clips, done, failed);
    bool settled = true;
    for (int64_t clip = begin; clip < end; ++clip)
      settled = settled && (done.contains(clip) || (failed_settles && failed.contains(clip)));
    if (!settled)
      for (int64_t clip = begin; clip < end; ++clip) pending.push_back(clip);
  };
  if (wanted.only.empty()) {
    for (int64_t unit = 0; unit * per_unit < wanted.clips; ++unit) add_unit(unit);
  } else {
    std::set<int64_t> units;
    for (const int64_t clip : wanted.only) units.insert(layout.UnitOf(clip));
    for (const int64_t unit : units) add_unit(unit);
  }
  return pending;
}

}  // namespace shimmer::dataset
