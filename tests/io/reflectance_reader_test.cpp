#include "io/reflectance_reader.h"

#include <gtest/gtest.h>

#include <sstream>

#include "support/error.h"

namespace goniofit {
namespace {

ReflectanceReadings read(const std::string& text) {
  std::istringstream in(text);
  return read_reflectances(in, "dhr.csv");
}

std::string message_of(const std::string& text) {
  try {
    (void)read(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "no error";
}

TEST(ReflectanceReader, ReadsColumnsInAnyOrder) {
  const ReflectanceReadings r =
      read("# sample: plaster\nu_550nm;THETA_I;550nm;650NM\n0.01;8;0.5;0.25\n0.02;60;0.6;1.05\n");
  EXPECT_EQ(r.theta_i_deg, (std::vector<double>{8.0, 60.0}));
  ASSERT_EQ(r.channels.size(), 2U);
  EXPECT_EQ(r.channels[0].name, "550nm");
  EXPECT_EQ(r.channels[0].values, (std::vector<double>{0.5, 0.6}));
  EXPECT_EQ(r.channels[0].u, (std::vector<double>{0.01, 0.02}));
  EXPECT_EQ(r.channels[1].values, (std::vector<double>{0.25, 1.05}));
  EXPECT_TRUE(r.channels[1].u.empty());
}

TEST(ReflectanceReader, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(message_of("theta_i,R\n8,0.5\n90,0.5\n"),
            "dhr.csv:3: column theta_i: \"90\" is out of range; expected degrees from 0 to below 90");
  EXPECT_EQ(message_of("theta_i,R\n8,50\n"),
            "dhr.csv:2: column R: \"50\" is out of range; expected a reflectance from 0 to 1");
  EXPECT_EQ(message_of("theta_i,R,u_R\n8,0.5,0\n"),
            "dhr.csv:2: column u_R: \"0\" is out of range; expected a standard uncertainty above 0");
  EXPECT_EQ(message_of("theta_i,R,u_G\n8,0.5,0.1\n"),
            "dhr.csv:1: column u_G: is the uncertainty of no channel; expected u_ and a channel's name");
  EXPECT_EQ(message_of("theta_i,R,r\n8,0.5,0.1\n"), "dhr.csv:1: column r: is there twice");
  EXPECT_EQ(message_of("R,G\n0.5,0.1\n"), "dhr.csv:1: column theta_i: is missing; expected theta_i and channels");
  EXPECT_EQ(message_of("theta_i\n8\n"),
            "dhr.csv:1: column theta_i: stands alone; expected channels beside it, such as R,G,B");
  EXPECT_EQ(message_of("theta_i,R\n"), "dhr.csv:1: there is no row after the header line; expected one a reading");
  EXPECT_NE(message_of("theta_i,R\n8\n"), "no error");
  EXPECT_NE(message_of("theta_i,R\n8,nan\n"), "no error");
  EXPECT_NE(message_of(""), "no error");
}

}  // namespace
}  // namespace goniofit
