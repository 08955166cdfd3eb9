// What the program says when something is wrong.
#pragma once

#include <string>

namespace shimmer::app {

// To stderr: "shimmer: MESSAGE", on one line, whatever a library or a file's name put into the message.
void PrintError(const std::string& message);

}  // namespace shimmer::app
