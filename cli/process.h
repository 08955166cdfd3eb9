// What a program arranges before its command runs.
#pragma once

#include <atomic>

namespace shimmer::cli {

// From now on the first Ctrl-C (SIGINT, SIGTERM) sets what this returns, for the command to end in good
// order; the second ends the program at once.
const std::atomic<bool>& ListenToSignals();

// OpenCV prints what it also throws; not after this.
void SilenceOpenCv();

}  // namespace shimmer::cli
