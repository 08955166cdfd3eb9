// What a program says when something is wrong.
#pragma once

#include <string>

namespace shimmer::cli {

// To stderr: "PROGRAM: MESSAGE", on one line, whatever a library or a file's name put into the message.
void PrintError(const std::string& program, const std::string& message);

}  // namespace shimmer::cli
