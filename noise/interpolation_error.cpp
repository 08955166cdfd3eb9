#include "noise/interpolation_error.h"

#include <algorithm>
#include <span>

#include "noise/portable_math.h"

namespace shimmer::noise {
namespace {

struct Entry {
  double steps_per_cell, max, rms;
};

// Above the last entry an error is taken to be that of the last.
constexpr Entry kGrid06Spacing2[] = {
    {2, 1.57, 0.258},       {2.5, 0.84, 0.155},     {3, 0.481, 0.0901},     {3.5, 0.292, 0.051},
    {4, 0.176, 0.0297},     {5, 0.0714, 0.0114},    {6, 0.0344, 0.005},     {7, 0.0188, 0.00252},
    {8, 0.0117, 0.00142},   {9, 0.0079, 0.00083},   {10, 0.0066, 0.00054},  {12, 0.0062, 0.00029},
    {16, 0.0062, 0.000224}, {24, 0.0062, 0.000196}, {32, 0.0062, 0.000167}, {64, 0.0062, 0.000139}};
constexpr Entry kGrid06Spacing4[] = {
    {2, 1.57, 0.258},       {2.5, 0.84, 0.155},     {3, 0.481, 0.0901},     {3.5, 0.292, 0.051},
    {4, 0.176, 0.0297},     {5, 0.0714, 0.0114},    {6, 0.0344, 0.005},     {7, 0.0188, 0.00252},
    {8, 0.0117, 0.00142},   {9, 0.0094, 0.00083},   {10, 0.0094, 0.00054},  {12, 0.0094, 0.00029},
    {16, 0.0094, 0.000224}, {24, 0.0094, 0.000196}, {32, 0.0094, 0.000167}, {64, 0.0094, 0.000139}};
constexpr Entry kGrid06[] = {
    {2, 1.58, 0.258},       {2.5, 0.84, 0.155},     {3, 0.488, 0.0901},     {3.5, 0.295, 0.051},
    {4, 0.178, 0.0297},     {5, 0.0722, 0.0114},    {6, 0.0349, 0.005},     {7, 0.0194, 0.00252},
    {8, 0.012, 0.00142},    {9, 0.0109, 0.00083},   {10, 0.0109, 0.00054},  {12, 0.0109, 0.00029},
    {16, 0.0109, 0.000224}, {24, 0.0109, 0.000196}, {32, 0.0109, 0.000167}, {64, 0.0109, 0.000139}};
constexpr Entry kGrid05[] = {
    {2, 1.71, 0.303},         {2.5, 1.05, 0.195},      {3, 0.635, 0.122},       {3.5, 0.403, 0.0715},
    {4, 0.246, 0.0444},       {5, 0.101, 0.0179},      {6, 0.0473, 0.00787},    {7, 0.0253, 0.00384},
    {8, 0.0145, 0.00209},     {9, 0.00905, 0.00122},   {10, 0.006, 0.00076},    {12, 0.00294, 0.000357},
    {16, 0.000958, 9.71e-05}, {24, 0.000197, 1.7e-05}, {32, 6.32e-05, 5.1e-06}, {64, 1e-05, 1e-06}};
constexpr Entry kGridPerlin[] = {
    {2, 0.457, 0.0661},      {2.5, 0.221, 0.0293},     {3, 0.119, 0.0189},      {3.5, 0.0773, 0.0096},
    {4, 0.0579, 0.00613},    {5, 0.034, 0.00271},      {6, 0.0212, 0.0015},     {7, 0.014, 0.000888},
    {8, 0.00966, 0.000583},  {9, 0.00695, 0.000383},   {10, 0.00515, 0.000268}, {12, 0.00306, 0.000144},
    {16, 0.00133, 5.43e-05}, {24, 0.000403, 1.34e-05}, {32, 0.000172, 4.8e-06}, {64, 2.2e-05, 1e-06}};
constexpr Entry kKey06[] = {
    {2, 0.878, 0.476},    {2.5, 0.536, 0.296},  {3, 0.331, 0.184},    {3.5, 0.213, 0.118},
    {4, 0.142, 0.0781},   {5, 0.0697, 0.0377},  {6, 0.0389, 0.0202},  {7, 0.0244, 0.0117},
    {8, 0.0165, 0.0072},  {9, 0.0118, 0.0046},  {10, 0.0118, 0.0031}, {12, 0.0118, 0.0026},
    {16, 0.0118, 0.0026}, {24, 0.0118, 0.0026}, {32, 0.0118, 0.0026}, {64, 0.0118, 0.0026}};
constexpr Entry kKey05[] = {
    {2, 1.04, 0.608},       {2.5, 0.639, 0.389},      {3, 0.405, 0.246},       {3.5, 0.265, 0.158},
    {4, 0.18, 0.104},       {5, 0.0933, 0.0489},      {6, 0.052, 0.0266},      {7, 0.0304, 0.0159},
    {8, 0.0188, 0.00995},   {9, 0.0122, 0.0065},      {10, 0.00815, 0.0044},   {12, 0.00429, 0.0022},
    {16, 0.00155, 0.00078}, {24, 0.000356, 0.000186}, {32, 0.000123, 6.6e-05}, {64, 1e-05, 5e-06}};
constexpr Entry kKeyPerlin[] = {
    {2, 0.271, 0.078},       {2.5, 0.152, 0.0449},     {3, 0.09, 0.0281},        {3.5, 0.0577, 0.0185},
    {4, 0.0385, 0.0127},     {5, 0.0219, 0.00646},     {6, 0.0154, 0.00365},     {7, 0.0111, 0.00227},
    {8, 0.00806, 0.00167},   {9, 0.00606, 0.00127},    {10, 0.00466, 0.00098},   {12, 0.00291, 0.00062},
    {16, 0.00135, 0.000293}, {24, 0.000434, 9.71e-05}, {32, 0.000191, 4.31e-05}, {64, 2.6e-05, 5.8e-06}};

constexpr double kMaxMargin = 1.03, kRmsMargin = 1.1;  // what longer searches still found, and more

// Straight between entries in log-log: errors fall as powers of the wavelength.
NoiseError LookUp(std::span<const Entry> table, double steps_per_cell) {
  const double steps = std::clamp(steps_per_cell, table.front().steps_per_cell, table.back().steps_per_cell);
  size_t i = 1;
  while (table[i].steps_per_cell < steps) ++i;
  const Entry &a = table[i - 1], &b = table[i];
  const double share = Log(steps / a.steps_per_cell) / Log(b.steps_per_cell / a.steps_per_cell);
  const auto between = [&](double from, double to) { return from * Exp(share * Log(to / from)); };
  return {kMaxMargin * between(a.max, b.max), kRmsMargin * between(a.rms, b.rms)};
}

}  // namespace

NoiseError GridError(NoiseKind kind, int spacing_px, double steps_per_cell) {
  if (kind == NoiseKind::kPerlin) return LookUp(kGridPerlin, steps_per_cell);
  if (kind == NoiseKind::kSimplex05) return LookUp(kGrid05, steps_per_cell);
  return LookUp(spacing_px == 2   ? kGrid06Spacing2
                : spacing_px == 4 ? kGrid06Spacing4
                                  : kGrid06,
                steps_per_cell);
}

NoiseError KeyFrameError(NoiseKind kind, double steps_per_cell) {
  return LookUp(kind == NoiseKind::kPerlin      ? std::span<const Entry>(kKeyPerlin)
                : kind == NoiseKind::kSimplex05 ? kKey05
                                                : kKey06,
                steps_per_cell);
}

NoiseError SizeOf(NoiseKind kind) {
  if (kind == NoiseKind::kPerlin) return {1.04, 0.30};
  return {KernelOf(kind).bound, kind == NoiseKind::kSimplex06 ? 0.55 : 0.63};
}

}  // namespace shimmer::noise
