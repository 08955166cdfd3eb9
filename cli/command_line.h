// What a program's main command does with its words, its text and its errors.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace shimmer::cli {

// Throws std::invalid_argument with the commands that there are if word is none of them. (CLI11 would say
// that a command is missing, and not which word is none.)
void RequireCommand(const CLI::App& app, const std::string& word);

// To stdout. Throws std::runtime_error where that can't be written.
void Print(const std::string& text);

// In a catch block: prints the exception as a line of the program whose name app has, and returns the exit
// code: kExitWrongInput for arguments and std::invalid_argument, kExitFailed for any other std::exception.
// --help and --version, which CLI11 throws too, are printed. What is no std::exception is thrown on.
int ReportCaught(const CLI::App& app);

}  // namespace shimmer::cli
