// Flow by a network, any that is saved as TorchScript.
#pragma once

#include <filesystem>

#include "restore/flow.h"

namespace shimmer::restore {

// Flows by one network, which is loaded and tried on two small frames at once. The file is what
// torch.jit.save writes, of a network as RAFT is: it takes two images, float 1x3xHxW (RGB, what is grey three
// times), and gives the flow from the first to the second, 1x2xHxW in px, or a tuple or list of flows whose
// last is the finest. White is 255 and black 0, unless the archive has an extra file "range" that says
// otherwise ("-1 1"). H and W are multiples of 8 and 128 or more: frames get their edges continued, evenly
// on both sides.
//
// Flows from one frame to several are computed at a time, each on one thread: the same bits on any number of
// threads.
//
// Throws std::invalid_argument where this build has no torch, and std::runtime_error, as the flows do, with
// the file and what torch says of it, where the network is none or gives anything but such a flow, finite.
FlowMaker TorchFlows(const std::filesystem::path& network);

}  // namespace shimmer::restore
