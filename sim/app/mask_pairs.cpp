#include "sim/app/mask_pairs.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>

namespace shimmer::app {
namespace {

size_t CommonBegin(std::string_view a, std::string_view b) {
  return static_cast<size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
}

// Of each name what is left without the beginning and then the end that all have.
std::vector<std::string_view> DifferingParts(std::span<const std::string> names) {
  std::vector<std::string_view> parts(names.begin(), names.end());
  size_t begin = parts.front().size();
  for (const std::string_view part : parts) begin = std::min(begin, CommonBegin(parts.front(), part));
  for (std::string_view& part : parts) part.remove_prefix(begin);
  size_t end = parts.front().size();
  for (const std::string_view part : parts)
    end = std::min(end,
                   static_cast<size_t>(
                       std::mismatch(part.rbegin(), part.rend(), parts[0].rbegin(), parts[0].rend()).first -
                       part.rbegin()));
  for (std::string_view& part : parts) part.remove_suffix(end);
  return parts;
}

}  // namespace

std::vector<size_t> PairMasks(std::span<const std::string> items, std::span<const std::string> masks) {
  if (items.size() != masks.size())
    throw std::invalid_argument("finds " + std::to_string(masks.size()) + ", must find one for each of the " +
                                std::to_string(items.size()));
  if (items.empty()) return {};
  const std::vector<std::string_view> item_parts = DifferingParts(items), mask_parts = DifferingParts(masks);
  std::map<std::string_view, size_t> mask_of;
  for (size_t i = 0; i < masks.size(); ++i) mask_of[mask_parts[i]] = i;
  std::vector<size_t> pairs;
  for (size_t i = 0; i < items.size(); ++i) {
    const auto found = mask_of.find(item_parts[i]);
    if (found == mask_of.end())
      throw std::invalid_argument(
          "has none for " + items[i] + ": no name has '" + std::string(item_parts[i]) +
          "' where the others differ. Names must differ as those of the videos do, or "
          "both be listed one by one, in the same order");
    pairs.push_back(found->second);
  }
  return pairs;
}

}  // namespace shimmer::app
