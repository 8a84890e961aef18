// goniofit report, and fit --report: the page as a file.

#include "cli/program_test.h"

namespace goniofit::test {
namespace {

class ReportCommand : public ProgramTest {
 protected:
  void SetUp() override {
    add_material();
    add_scan();
  }
};

TEST_F(ReportCommand, WritesThePageAndNothingElse) {
  const Outcome outcome = run_here({"report", "m.json", "scan.csv", "-o", "page.html"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out + outcome.err, "");
  const std::string page = content("page.html");
  EXPECT_EQ(page.rfind("<!doctype html>", 0), 0U);
  EXPECT_NE(page.find("</html>"), std::string::npos);
  EXPECT_EQ(files(), (std::vector<std::string>{"m.json", "page.html", "scan.csv"}));
  EXPECT_EQ(run_here({"report", "m.json", "scan.csv", "-o", "-"}).out, page);
}

TEST_F(ReportCommand, NamesItsInputsByTheirHashes) {
  add("scan.csv", "theta_i,theta_r,R,G,B\n30,-20,0.03,0.001,0.001\n30,30,0.2,0.2,0.2\n60,60,1,1,1\n");
  ASSERT_EQ(run_here({"report", "m.json", "scan.csv", "-o", "page.html"}).status, 0);
  const std::string page = content("page.html");
  // sha256sum of the line above
  EXPECT_NE(page.find("d23d4184943627bd914a85a7fc98a44197005068846e416493a00012492b4391"), std::string::npos);
  EXPECT_NE(page.find(R"("command":"goniofit report m.json scan.csv -o PAGE")"), std::string::npos);
}

TEST_F(ReportCommand, OfAFitIsTheSameWhateverItIsCalled) {
  const std::vector<std::string> fit{"fit", "scan.csv", "--n", "1.7", "--components", "dd,uds,fs", "--profile=slope"};
  for (const char* const name : {"a.html", "b.html"}) {
    std::vector<std::string> words = fit;
    words.insert(words.end(), {"--report", name});
    ASSERT_EQ(run_here(words).status, 0);
  }
  EXPECT_EQ(content("a.html"), content("b.html"));
  EXPECT_NE(content("a.html").find(R"("profiles":[{"name":"slope")"), std::string::npos);
}

TEST_F(ReportCommand, BadInputIsStatus2AndLeavesNoPage) {
  add("rg.csv", "theta_i,theta_r,R,G\n30,30,0.2,0.2\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"report", "m.json", "rg.csv", "-o", "p.html"}, "B"},
      {{"report", "m.json", "scan.csv", "-o", "m.json"}, "is an input of this command"},
      {{"report", "m.json", "scan.csv", "-o", "scan.csv"}, "is an input of this command"},
      {{"report", "scan.csv", "scan.csv", "-o", "p.html"}, "scan.csv:"},
      {{"report", "m.json", "m.json", "-o", "p.html"}, "m.json:"},
      {{"fit", "scan.csv", "--report", "scan.csv"}, "is an input of this command"},
      {{"fit", "scan.csv", "--report", "p.html", "-o", "p.html"}, "two outputs have this name"},
  };
  for (const auto& [words, message] : cases) {
    const Outcome outcome = run_here(words);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
    EXPECT_EQ(files(), (std::vector<std::string>{"m.json", "rg.csv", "scan.csv"}));
  }
}

TEST_F(ReportCommand, AFolderThatIsNotThereIsKnownBeforeTheFit) {
  const Outcome outcome = run_here({"fit", "scan.csv", "--report", "no/such/page.html"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("there is no folder no/such"), std::string::npos) << outcome.err;
}

TEST_F(ReportCommand, AFullDiskLeavesWhatWasThere) {
  add("page.html", "before");
  const Outcome outcome = run_here({"report", "m.json", "scan.csv", "-o", "page.html"}, {.largest_file_bytes = 100000});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_EQ(content("page.html"), "before");
}

}  // namespace
}  // namespace goniofit::test
