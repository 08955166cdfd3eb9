// The program `unshimmer`: its commands, and the one place where errors become a line and an exit code.
#pragma once

#include <atomic>

namespace shimmer::restore::app {

// Runs the command that the arguments name; returns the exit code (cli/exit_codes.h). listen is called by a
// command that can end in good order, and gives what the signals to do so set.
int RunUnshimmer(int argc, const char* const* argv, const std::atomic<bool>& (*listen)());

}  // namespace shimmer::restore::app
