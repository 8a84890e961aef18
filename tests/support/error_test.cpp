#include "support/error.h"

#include <gtest/gtest.h>

#include <string>

namespace goniofit {
namespace {

TEST(Error, InputErrorNamesFileLineAndColumn) {
  const Error error = input_error("scan.csv", 7, "theta_r", "95 is outside 0 to 90");
  EXPECT_STREQ(error.what(), "scan.csv:7: column theta_r: 95 is outside 0 to 90");
  EXPECT_EQ(error.kind(), ErrorKind::bad_input);
}

TEST(Error, InputErrorLeavesOutWhatIsNotKnown) {
  EXPECT_STREQ(input_error("scan.csv", 0, "R", "missing").what(), "scan.csv: column R: missing");
  EXPECT_STREQ(input_error("scan.csv", 3, "", "empty").what(), "scan.csv:3: empty");
  EXPECT_STREQ(input_error("scan.csv", 0, "", "empty").what(), "scan.csv: empty");
}

TEST(Error, KeyErrorNamesThePointerAndTheRootAsSlash) {
  EXPECT_STREQ(key_error("m.json", "/surface/tau_um", "below 0").what(), "m.json: /surface/tau_um: below 0");
  EXPECT_STREQ(key_error("m.json", "", "not an object").what(), "m.json: /: not an object");
  EXPECT_EQ(key_error("m.json", "", "").kind(), ErrorKind::bad_input);
}

TEST(Error, KindsAreTheExitStatuses) {
  EXPECT_EQ(static_cast<int>(ErrorKind::failed_result), 1);
  EXPECT_EQ(static_cast<int>(usage_error("no scan").kind()), 2);
  EXPECT_EQ(static_cast<int>(system_error("cannot write x").kind()), 3);
  EXPECT_STREQ(usage_error("no scan").what(), "no scan");
  EXPECT_STREQ(system_error("cannot write x").what(), "cannot write x");
}

}  // namespace
}  // namespace goniofit
