// The program `shimmer`: its commands, and the one place where errors become a line and an exit code.
#pragma once

#include <atomic>

namespace shimmer::app {

// Runs the command that the arguments name; returns the exit code: 0 done, 1 failed on the way, 2 wrong
// input, 130 interrupted. listen is called by a command that can end in good order, and gives what the
// signals to do so set; others end where they are.
int RunShimmer(int argc, const char* const* argv, const std::atomic<bool>& (*listen)());

}  // namespace shimmer::app
