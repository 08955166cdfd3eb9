#include "cli/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/error_line.h"
#include "cli/exit_codes.h"
#include "cli/listed.h"

namespace shimmer::cli {
namespace {

using testing::HasSubstr;

// What is printed to stderr and returned when this is thrown in a program "demo".
template <class Throw>
std::pair<int, std::string> Reported(const CLI::App& app, Throw throw_it) {
  testing::internal::CaptureStderr();
  int exit_code = -1;
  try {
    throw_it();
  } catch (...) {
    exit_code = ReportCaught(app);
  }
  return {exit_code, testing::internal::GetCapturedStderr()};
}

TEST(CommandLine, EachErrorIsALineAndAnExitCode) {
  const CLI::App app("", "demo");
  EXPECT_EQ(Reported(app, [] { throw std::invalid_argument("a: is wrong"); }),
            std::pair(kExitWrongInput, std::string("demo: a: is wrong\n")));
  EXPECT_EQ(Reported(app, [] { throw std::runtime_error("disk: full"); }),
            std::pair(kExitFailed, std::string("demo: disk: full\n")));
  const auto [exit_code, line] = Reported(app, [] { throw CLI::RequiredError("--out"); });
  EXPECT_EQ(exit_code, kExitWrongInput);
  EXPECT_THAT(line, HasSubstr("--out"));
  EXPECT_THAT(line, HasSubstr("(demo --help)"));
  EXPECT_THROW(Reported(app, [] { throw 7; }), int);
  testing::internal::GetCapturedStderr();
}

TEST(CommandLine, WordsThatAreNoCommandAreNamed) {
  CLI::App app("", "demo");
  app.add_subcommand("draw");
  app.add_subcommand("read");
  EXPECT_NO_THROW(RequireCommand(app, "read"));
  try {
    RequireCommand(app, "raed");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "unknown command 'raed', must be 'draw' or 'read' (demo --help)");
  }
}

TEST(CommandLine, NamesInASentence) {
  EXPECT_EQ(Listed({}, "or"), "");
  const std::vector<std::string> names = {"a", "b", "c"};
  EXPECT_EQ(Listed(std::span(names).first(1), "or"), "'a'");
  EXPECT_EQ(Listed(names, "and"), "'a', 'b' and 'c'");
}

TEST(ErrorLine, IsOneWhateverTheMessageHolds) {
  testing::internal::CaptureStderr();
  PrintError("demo", "a\nb\x1B[2J\x7F");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "demo: a b?[2J?\n");
}

}  // namespace
}  // namespace shimmer::cli
