// Evaluations made by hand, for tests of the page that shows them.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include "restore/app/evaluation/results.h"

namespace shimmer::restore::app {

using Numbers = std::map<Measure, double>;

inline void AddRow(ClipResult& clip, const std::string& variant, const std::string& stage,
                   const Numbers& numbers) {
  ResultRow row{variant, stage, {}};
  for (const auto& [measure, number] : numbers) row.measures[measure] = number;
  clip.rows.push_back(row);
}

// The input and the full pipeline, of one PSNR each.
inline ClipResult PlainClip(const std::string& name, double input_db, double full_db) {
  ClipResult clip;
  clip.facts = {
      .name = name, .frames = 30, .size = {160, 120}, .tilt_rms_px = {}, .shakes = {}, .objects = {}};
  AddRow(clip, kInputName, kResultStage, {{Measure::kPsnr, input_db}});
  AddRow(clip, kFullName, kResultStage, {{Measure::kPsnr, full_db}, {Measure::kTime, 12.5}});
  return clip;
}

inline Evaluation PlainEvaluation() {
  return {.set = "set",
          .variants = {{kInputName, VariantKind::kInput, ""}, {kFullName, VariantKind::kPipeline, ""}},
          .clips = {},
          .real = {},
          .clips_of_set = 0};
}

inline const std::string kMarkupName = "<b>&\"";
inline const std::string kLongName(200, 'w');

// A whole one, with everything that a page may have to show: every kind of variant, names that are markup or
// long, clips that failed, a clip restored to the true frames, real video.
inline Evaluation LargeEvaluation(int clips) {
  Evaluation evaluation{.set = "sets/" + kMarkupName,
                        .variants = {{kInputName, VariantKind::kInput, ""},
                                     {kFullName, VariantKind::kPipeline, ""},
                                     {"no segment", VariantKind::kAblation, "segment=off"},
                                     {"no sharpen", VariantKind::kAblation, "sharpen=off"},
                                     {"window 9", VariantKind::kAblation, "window=9"},
                                     {"median", VariantKind::kBaseline, "of 30 frames"},
                                     {kMarkupName, VariantKind::kMethod, "others/" + kMarkupName},
                                     {kLongName, VariantKind::kMethod, "others/" + kLongName}},
                        .clips = {},
                        .real = {},
                        .clips_of_set = clips + 3};
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> part(0, 1);
  const auto scores = [&](double psnr_db, double sharpness, double ms) {
    return Numbers{{Measure::kPsnr, psnr_db},
                   {Measure::kSsim, 1 - 1 / psnr_db * 4},
                   {Measure::kPsnrBackground, psnr_db + 0.6 * part(generator)},
                   {Measure::kSsimBackground, 0.9},
                   {Measure::kPsnrForeground, psnr_db - 3 * part(generator)},
                   {Measure::kSsimForeground, 0.8},
                   {Measure::kPsnrBox, psnr_db - 2 * part(generator)},
                   {Measure::kSsimBox, 0.8},
                   {Measure::kLineDeviation, 4 - sharpness + part(generator)},
                   {Measure::kStability, 6 / (1 + sharpness)},
                   {Measure::kTime, ms}};
  };
  for (int i = 0; i < clips; ++i) {
    const double tilt_px = 0.35 * std::pow(2.0, 3 * part(generator)),
                 input_db = 30 - 3 * tilt_px + part(generator);
    ClipResult clip;
    clip.facts = {.name = i == 0   ? kMarkupName
                          : i == 1 ? kLongName
                                   : std::string(6 - std::to_string(i).size(), '0') + std::to_string(i),
                  .frames = 60,
                  .size = {320, i % 2 ? 240 : 400},
                  .tilt_rms_px = tilt_px,
                  .shakes = i % 3 == 0,
                  .objects = i % 4};
    Numbers input = scores(input_db, 0, 0);
    input.erase(Measure::kTime);
    AddRow(clip, kInputName, kResultStage, input);
    if (i % 13 == 5) {
      clip.errors.push_back(
          {kFullName, "clips/" + clip.facts.name + "/turbulent/0007.png: <unexpected> end of file"});
      evaluation.clips.push_back(clip);
      continue;
    }
    const double gain_db = 2 + tilt_px + 2 * (part(generator) - 0.7);
    AddRow(clip, kFullName, "look",
           {{Measure::kFoundTilt, tilt_px * (0.8 + 0.3 * part(generator))}, {Measure::kTime, 3}});
    Numbers stabilise = scores(input_db + 0.4, 0.5, 7);
    stabilise.insert({{Measure::kShiftMean, 0.1 * part(generator)},
                      {Measure::kShiftP95, 0.2},
                      {Measure::kShiftMost, 0.4}});
    AddRow(clip, kFullName, "stabilise", stabilise);
    AddRow(clip, kFullName, "segment",
           {{Measure::kIou, 0.6 + 0.3 * part(generator)},
            {Measure::kPrecision, 0.8},
            {Measure::kRecall, 0.75},
            {Measure::kTime, 9}});
    AddRow(clip, kFullName, "stack", scores(input_db + 0.7 * gain_db, 2, 21));
    AddRow(clip, kFullName, "blend", scores(input_db + 0.8 * gain_db, 2.2, 4));
    AddRow(clip, kFullName, "sharpen", scores(input_db + gain_db, 2.4, 88));
    AddRow(clip, kFullName, kResultStage, scores(input_db + gain_db, 2.4, 132));
    for (size_t v = 2; v < evaluation.variants.size(); ++v)
      AddRow(clip, evaluation.variants[v].name, kResultStage,
             scores(input_db + gain_db - 0.4 * double(v), 2, 20 * double(v)));
    evaluation.clips.push_back(clip);
  }
  for (const char* name : {"videos/door.mp4", "videos/<i>chimney</i>.mp4"}) {
    ClipResult video;
    video.facts = {
        .name = name, .frames = 120, .size = {320, 240}, .tilt_rms_px = {}, .shakes = {}, .objects = {}};
    AddRow(video, kInputName, kResultStage, {{Measure::kLineDeviation, 5.1}, {Measure::kStability, 7.5}});
    AddRow(video, kFullName, kResultStage,
           {{Measure::kLineDeviation, 3.2}, {Measure::kStability, 2.5}, {Measure::kTime, 140}});
    video.errors.push_back({"median", "no memory"});
    evaluation.real.push_back(video);
  }
  return evaluation;
}

}  // namespace shimmer::restore::app
