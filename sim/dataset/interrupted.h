// How a long task ends when the person asks for it.
#pragma once

#include <atomic>
#include <stdexcept>

namespace shimmer::dataset {

// The person has asked to stop.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

// For those who can't be asked.
inline const std::atomic<bool> kNeverStop{false};

}  // namespace shimmer::dataset
