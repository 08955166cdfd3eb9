#include "noise/field_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "noise/field_cost.h"
#include "noise/interpolation_error.h"

namespace shimmer::noise {
namespace {

constexpr int kMostKeyFrames = 16;
constexpr int kBudgetParts = 512;  // the budget is handed out in parts; an error takes whole ones

struct Candidate {
  OctaveWay way;
  double cycles;  // a frame
};

// How many of an octave's cells an axis of the area samples: few, too, where its pixels come to lie in the
// same cells again (as with a step of 256 cells).
double CellsAlong(Fixed step, int size_px) {
  constexpr uint32_t kNear = 1u << 22;  // a quarter of a cell, of 8 bits of cell and 24 of fraction
  const double cells = std::min(1.0, step.ToDouble()) * size_px;
  for (int q = 1; q < size_px && step.ToDouble() >= 0.5; ++q) {
    const uint32_t place = (step * q).Cell8Fraction24();
    if (std::min(place, -place) < kNear) return std::min<double>(cells, q);
  }
  return cells;
}

// The RMS over any frame, from that over all places: the mean square of n cells spreads by less than twice
// itself / sqrt(n), of which five are granted, and never exceeds the square of the largest error.
NoiseError OverFrames(NoiseError error, double cells) {
  return {error.max, std::min(error.max, error.rms * std::sqrt(1 + 10 / std::sqrt(cells)))};
}

class Planner {
 public:
  Planner(NoiseKind kind, int width, int height, int frames, int border_px)
      : cost_(kind, width + 2 * border_px, height + 2 * border_px, frames),
        kind_(kind),
        width_(width),
        height_(height) {}

  std::vector<Candidate> CandidatesOf(const Octave& octave) const {
    std::vector<Candidate> candidates;
    const double cells = CellsOf(octave);
    const double amplitude = octave.amplitude;
    const auto add = [&](OctaveWay way, double cycles, NoiseError error) {
      error = OverFrames(error, cells);
      way.max_error = amplitude * error.max, way.rms_error = amplitude * error.rms;
      candidates.push_back({way, cycles});
    };

    add({.kind = OctaveWayKind::kFull}, cost_.Full(), {});
    if (const std::optional<int> period = PeriodPx(octave.step_px))
      add({.kind = OctaveWayKind::kTiled, .period_px = *period}, cost_.Tiled(*period), {});
    add({.kind = OctaveWayKind::kDropped}, 0, SizeOf(kind_));

    for (int spacing = 1; spacing <= kWidestSpacing; spacing *= 2)
      for (int keys = 1; keys <= kMostKeyFrames; keys *= 2) {
        if ((spacing == 1 && keys == 1) || (keys > 1 && !cost_.CanKeep(spacing))) continue;
        if (keys > 1 && octave.step_frame == Fixed()) continue;  // it stands still: any frame is the key
        const double steps = 1 / (octave.step_px.ToDouble() * spacing),
                     key_steps = 1 / (octave.step_frame.ToDouble() * keys);
        if (steps < kFewestStepsPerCell || (keys > 1 && key_steps < kFewestStepsPerCell)) continue;
        NoiseError error;
        if (spacing > 1) error = GridError(kind_, spacing, steps);
        if (keys > 1) {
          const NoiseError between = KeyFrameError(kind_, key_steps);
          error = {between.max + kKeyFrameGain * error.max, between.rms + kKeyFrameGain * error.rms};
        }
        add({.kind = OctaveWayKind::kGrid, .spacing_px = spacing, .key_frames = keys},
            cost_.OnGrid(spacing, keys), error);
      }
    return candidates;
  }

  double SplineCycles() const { return cost_.Spline(); }

  // Of the sum over any frame. Two octaves' errors add like independent ones but for their correlation, which
  // n cells of the faster one leave below 6 / sqrt(n); octaves of about one frequency may be alike.
  double RmsOf(std::span<const Octave> octaves, std::span<const OctaveWay> ways) const {
    double squares = 0;
    for (size_t i = 0; i < ways.size(); ++i)
      for (size_t j = 0; j < ways.size(); ++j) {
        const double product = ways[i].rms_error * ways[j].rms_error;
        if (product == 0) continue;
        const double a = octaves[i].step_px.ToDouble(), b = octaves[j].step_px.ToDouble();
        const bool alike = std::max(a, b) < 1.5 * std::min(a, b);
        const double cells = std::max(CellsOf(octaves[i]), CellsOf(octaves[j]));
        squares += product * (alike ? 1 : std::min(1.0, 6 / std::sqrt(cells)));
      }
    return std::sqrt(squares);
  }

 private:
  double CellsOf(const Octave& octave) const {
    return CellsAlong(octave.step_px, width_) * CellsAlong(octave.step_px, height_);
  }

  FieldCost cost_;
  NoiseKind kind_;
  int width_, height_;
};

struct Choice {
  std::vector<OctaveWay> ways;
  double cycles = 0;
};

using Candidates = std::vector<std::vector<Candidate>>;  // of each octave
enum class AddUp { kErrors, kSquares };

// How many parts of the budget an error takes; more than all if it doesn't fit.
int PartsOf(const OctaveWay& way, ErrorBudget budget, AddUp rms) {
  const double of_rms = way.rms_error > 0 ? way.rms_error / budget.rms : 0,
               of_max = way.max_error > 0 ? way.max_error / budget.max : 0;
  const double share = std::max(of_max, rms == AddUp::kSquares ? of_rms * of_rms : of_rms);
  return share <= 1 ? static_cast<int>(std::ceil(share * kBudgetParts)) : kBudgetParts + 1;
}

// The cheapest choice of one candidate an octave whose errors add up to the budget, the RMS ones or their
// squares: least cycles for every number of parts, octave by octave.
Choice Cheapest(const Candidates& octaves, bool splines, ErrorBudget budget, AddUp add_up) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::vector<double> least(kBudgetParts + 1, 0.0);  // with at most so many parts
  std::vector<std::vector<const Candidate*>> taken;
  for (const std::vector<Candidate>& candidates : octaves) {
    std::vector<double> next(kBudgetParts + 1, kNever);
    std::vector<const Candidate*>& take = taken.emplace_back(kBudgetParts + 1);
    for (const Candidate& candidate : candidates) {
      if (candidate.way.spacing_px > 1 && !splines) continue;
      const int needed = PartsOf(candidate.way, budget, add_up);
      for (int parts = needed; parts <= kBudgetParts; ++parts) {
        const double cycles = least[parts - needed] + candidate.cycles;
        if (cycles < next[parts]) next[parts] = cycles, take[parts] = &candidate;
      }
    }
    least = std::move(next);
  }
  Choice choice{std::vector<OctaveWay>(octaves.size()), least[kBudgetParts]};
  int parts = kBudgetParts;
  for (size_t i = octaves.size(); i-- > 0;) {
    choice.ways[i] = taken[i][parts]->way;
    parts -= PartsOf(choice.ways[i], budget, add_up);
  }
  return choice;
}

Choice Cheapest(const Candidates& octaves, double spline_cycles, ErrorBudget budget, AddUp add_up) {
  Choice without = Cheapest(octaves, false, budget, add_up), with = Cheapest(octaves, true, budget, add_up);
  with.cycles += spline_cycles;
  return with.cycles < without.cycles ? with : without;
}

}  // namespace

std::optional<int> PeriodPx(Fixed step_px) {
  for (int period = 64; period <= 1024; period += 64)
    if ((step_px * period).bits() % (int128{256} << 64) == 0) return period;
  return std::nullopt;
}

FieldPlan PlanOctaves(std::span<const Octave> octaves, NoiseKind kind, int width, int height, int frames,
                      ErrorBudget budget, int border_px) {
  if (width < 1 || height < 1 || frames < 1 || border_px < 0 || !(budget.max >= 0) || !(budget.rms >= 0))
    throw std::invalid_argument("plan of " + std::to_string(frames) + " frames of " + std::to_string(width) +
                                "x" + std::to_string(height) + " px, error budget " +
                                std::to_string(budget.max) + " and " + std::to_string(budget.rms) +
                                " RMS, must be at least 1 frame of 1x1, budgets at least 0");
  const Planner planner(kind, width, height, frames, border_px);
  Candidates candidates;
  for (const Octave& octave : octaves) candidates.push_back(planner.CandidatesOf(octave));
  Choice choice = Cheapest(candidates, planner.SplineCycles(), budget, AddUp::kErrors);
  // RMS errors that are nearly independent add up to less: as much more is tried as their sum then allows
  if (std::isfinite(budget.rms))
    for (double share = 1; share > 0.3; share *= 0.95) {
      Choice more =
          Cheapest(candidates, planner.SplineCycles(), {budget.max, share * budget.rms}, AddUp::kSquares);
      if (planner.RmsOf(octaves, more.ways) > budget.rms) continue;
      if (more.cycles < choice.cycles) choice = std::move(more);
      break;
    }

  FieldPlan plan{std::move(choice.ways)};
  for (const OctaveWay& way : plan.octaves) plan.max_error += way.max_error;
  plan.rms_error = planner.RmsOf(octaves, plan.octaves);
  return plan;
}

}  // namespace shimmer::noise
