// How a video is to be restored, as a person says it on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "restore/app/restoration.h"

namespace shimmer::restore::app {

void AddSettingsOptions(CLI::App& command, RestoreSettings& settings);

// Changes one of them: stabilise, stack or sharpen "on" or "off"; segment "fused", "aof" or "off"; register
// "auto", "on" or "off"; flow and model as the options of these names. Throws std::invalid_argument that
// names what there is, for another key or value.
void ChangeSetting(RestoreSettings& settings, const std::string& key, const std::string& value);

}  // namespace shimmer::restore::app
