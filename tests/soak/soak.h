// What the tests of this room share: each is there twice, small and in the default run (faults.*), and at its
// full size (soak.*, scripts/soak.sh). What was counted and measured is told on a line of its own.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace shimmer::app {

inline bool InSoak() { return std::getenv("SHIMMER_SOAK") != nullptr; }

inline int Times(int fast, int soak) { return InSoak() ? soak : fast; }

// A line of scripts/soak.sh's list.
inline void Tell(const std::string& text) { std::printf("counted: %s\n", text.c_str()); }

}  // namespace shimmer::app
