// Numbers of an evaluation as its page shows them.
#pragma once

#include <optional>
#include <string>

#include "restore/app/evaluation/measures.h"
#include "restore/app/evaluation/summary.h"

namespace shimmer::restore::app {

inline constexpr const char* kAbsent = "–";

enum class Sign {
  kOfNegative,
  kAlways,  // of a gain: "+1.20"; zero has none
};

// "1.20", "inf", "-inf"; kAbsent where there is none, or what is no number (a gain of inf over inf).
std::string Shown(const Value& value, int decimals, Sign sign = Sign::kOfNegative);
std::string ShownWithUnit(const Value& value, const MeasureText& text, Sign sign = Sign::kOfNegative);

// "± 0.12", on one line; empty without a margin.
std::string MarginText(const std::optional<MeanOfClips>& mean, int decimals);

// As scripts read it: "1.23456789", "-Infinity". Of what Shown shows as a number.
std::string Exact(double value);

Value MeanAlone(const std::optional<MeanOfClips>& mean);

// Of all clips; a group without clips where there are none.
ClipGroup AllOf(const std::vector<ClipResult>& clips);

// What a stage of the full pipeline found out on the way (shifts, masks, tilt): of the first of its rows that
// has it.
Value Found(const ClipResult& clip, Measure measure);
std::optional<MeanOfClips> MeanFound(const ClipGroup& group, Measure measure);

// How much better the full pipeline's result is than the input; absent where it is no number.
Value FullGain(const ClipResult& clip);

}  // namespace shimmer::restore::app
