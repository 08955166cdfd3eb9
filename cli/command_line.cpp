#include "cli/command_line.h"

#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <vector>

#include "cli/error_line.h"
#include "cli/exit_codes.h"
#include "cli/listed.h"

namespace shimmer::cli {

void RequireCommand(const CLI::App& app, const std::string& word) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  if (std::ranges::count(commands, word) > 0) return;
  throw std::invalid_argument("unknown command '" + word + "', must be " + Listed(commands, "or") + " (" +
                              app.get_name() + " --help)");
}

void Print(const std::string& text) {
  std::cout << text << std::flush;
  if (!std::cout) throw std::runtime_error("standard output: can't be written");
}

int ReportCaught(const CLI::App& app) {
  try {
    throw;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    PrintError(app.get_name(), std::string(error.what()) + " (" + app.get_name() + " --help)");
    return kExitWrongInput;
  } catch (const std::invalid_argument& error) {
    PrintError(app.get_name(), error.what());
    return kExitWrongInput;
  } catch (const std::exception& error) {
    PrintError(app.get_name(), error.what());
    return kExitFailed;
  }
}

}  // namespace shimmer::cli
