// What a file of weights says of its network: sizes, and how to use it.
#pragma once

#include <string>
#include <vector>

#include "restore/safe_tensors.h"

namespace shimmer::restore {

// The sizes of a Restormer (Zamir et al., "Restormer: Efficient Transformer for High-Resolution Image
// Restoration", CVPR 2022, figure 2): an encoder of levels, each of half the one before's pixels an axis and
// twice its channels, the last of which is the bottom; a decoder back up; and refinement, at the first level.
// The first level's decoder and refinement have twice its channels, as their input, two halves, is not
// reduced.
struct RestormerShape {
  int width = 48;                       // channels of the first level: even, in [2, 512]
  std::vector<int> blocks{4, 6, 6, 8};  // of each level, 2 to 6 levels; each in [1, 64]
  std::vector<int> heads{1, 2, 4, 8};   // of attention: each divides its level's channels
  int refinement = 4;                   // blocks: in [0, 64]
  double expansion = 2.66;              // hidden over other channels: in (0, 16], at least one hidden channel
  bool norm_with_bias = true;           // norm: "with_bias" or "bias_free"
  int unshuffle = 1;                    // px an axis that become channels first: 1, 2, 4 or 8

  int Levels() const { return static_cast<int>(blocks.size()); }
  int Channels(int level) const { return width << level; }
  int DecoderChannels(int level) const { return level == 0 ? 2 * width : Channels(level); }
  int Hidden(int channels) const { return static_cast<int>(channels * expansion); }
  int SizeMultiple() const { return unshuffle << (Levels() - 1); }  // px: sizes that need no padding
};

// What is needed of any network.
struct TileCard {
  std::string name;
  int tile_px = 256;    // images larger than this are restored in parts, in [16, 16384]
  int overlap_px = 32;  // of neighbouring parts, in [0, tile_px / 2)
  std::string text;     // all of the card, JSON
};

struct ModelCard : TileCard {
  RestormerShape shape;
};

// The card that metadata "card" holds, JSON:
//   {"format": 1, "network": "restormer", "name": "...", "width": 16, "blocks": [2, 2, 4],
//    "heads": [1, 2, 4], "refinement": 1, "expansion": 2.66, "norm": "bias_free", "unshuffle": 2,
//    "tile": 256, "overlap": 32}
// All of these are needed; other keys say what they like.
//
// Throws std::runtime_error with the file, the key, its value and what it may be.
ModelCard ReadModelCard(const SafeTensors& file);

// Of the card "format", "name", "tile" and "overlap" alone: of a network that is built otherwise. Throws as
// that does.
TileCard ReadTileCard(const SafeTensors& file);

}  // namespace shimmer::restore
