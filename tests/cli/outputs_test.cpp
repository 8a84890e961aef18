// Outputs are whole or not there, whatever goes wrong; inputs and earlier outputs survive.

#include <nlohmann/json.hpp>

#include "cli/program_test.h"

namespace goniofit::test {
namespace {

class Outputs : public ProgramTest {
 protected:
  void SetUp() override {
    add_material();
    add_scan();
    before_ = files();
  }
  // Each command that writes a file, up to the name of the file.
  const std::vector<std::vector<std::string>> writers_{{"fit", "scan.csv", "-o"},
                                                       {"fit", "scan.csv", "--table"},
                                                       {"simulate", "m.json", "--sampling", "incidence-plane", "-o"},
                                                       {"eval", "m.json", "scan.csv", "-o"},
                                                       {"export", "m.json", "--format", "csv", "-o"},
                                                       {"export", "m.json", "--format", "exr", "--size", "16", "-o"}};
  [[nodiscard]] Outcome write_to(std::vector<std::string> writer, const std::string& target,
                                 RunOptions options = {}) const {
    writer.push_back(target);
    return run_here(writer, std::move(options));
  }
  std::vector<std::string> before_;
};

TEST_F(Outputs, AMissingFolderIsASystemFailure) {
  for (const auto& writer : writers_) {
    const Outcome outcome = write_to(writer, "no/such/out");
    EXPECT_EQ(outcome.status, 3) << writer.front() << outcome.err;
    EXPECT_EQ(outcome.err, "cannot write no/such/out: there is no folder no/such\n");
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(files(), before_);
  }
}

TEST_F(Outputs, AFolderAsTargetIsASystemFailure) {
  std::filesystem::create_directory(folder_ / "dir");
  for (const auto& writer : writers_) EXPECT_EQ(write_to(writer, "dir").status, 3) << writer.front();
  EXPECT_TRUE(names_in(folder_ / "dir").empty());
}

TEST_F(Outputs, AFullDiskLeavesTheEarlierOutputAndNothingElse) {
  for (const auto& writer : writers_) {
    add("out", "earlier");
    const Outcome outcome = write_to(writer, "out", {.stdout_path = "/dev/null", .largest_file_bytes = 100});
    EXPECT_EQ(outcome.status, 3) << writer.front() << ' ' << writer.back() << ": " << outcome.err;
    EXPECT_EQ(content("out"), "earlier");
    EXPECT_EQ(files().size(), before_.size() + 1) << writer.front();
  }
}

TEST_F(Outputs, APlotOnAFullDiskLeavesNothing) {
  for (const char* name : {"p.svg", "p.png"}) {
    const Outcome outcome =
        run_here({"fit", "scan.csv", "--plot", name}, {.stdout_path = "/dev/null", .largest_file_bytes = 20000});
    EXPECT_EQ(outcome.status, 3) << outcome.err;
    EXPECT_EQ(files(), before_) << name;
  }
}

TEST_F(Outputs, AFullStandardOutputIsASystemFailure) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"fit", "scan.csv"},
                                             {"fit", "scan.csv", "--json"},
                                             {"fit", "scan.csv", "-o", "-"},
                                             {"inspect", "scan.csv"},
                                             {"simulate", "m.json", "--sampling", "hemisphere"},
                                             {"eval", "m.json", "scan.csv"},
                                             {"export", "m.json", "--format", "json"},
                                             {"models"},
                                             {"--help"},
                                             {"--version"}}) {
    const Outcome outcome = run_here(arguments, {.stdout_path = "/dev/full"});
    EXPECT_EQ(outcome.status, 3) << arguments.front();
    EXPECT_NE(outcome.err.find("standard output"), std::string::npos) << arguments.front() << outcome.err;
  }
}

TEST_F(Outputs, TooLittleMemoryIsASystemFailure) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer reserves more address space than any limit that is small";
#endif
  std::string large = "theta_i,theta_r,R\n";
  for (int i = 0; i < 400000; ++i) large += "30," + std::to_string(i % 80) + ".5,0.125\n";
  add("large.csv", large);
  constexpr std::size_t megabyte = 1 << 20;
  bool ran_out = false;
  // How much the program takes to start depends on the machine: from too little to start to enough.
  for (std::size_t limit = 16; limit <= 512 && !ran_out; limit += 4) {
    const Outcome outcome =
        run_here({"eval", "m.json", "large.csv", "-o", "out.csv"}, {.memory_bytes = limit * megabyte});
    if (outcome.status == 0) break;
    ran_out = outcome.status == 3 && outcome.err == "goniofit: out of memory\n";
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.csv"));
  }
  EXPECT_TRUE(ran_out);
}

TEST_F(Outputs, AnInputIsNeverOverwritten) {
  std::filesystem::create_symlink("scan.csv", folder_ / "link.csv");
  add("r.toml", "components = [\"dd\", \"uds\"]\n");
  std::filesystem::create_directory(folder_ / "sub");
  const std::string scan = content("scan.csv");
  const std::string material = content("m.json");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"fit", "scan.csv", "-o", "scan.csv"},
                                             {"fit", "scan.csv", "-o", "./sub/../scan.csv"},
                                             {"fit", "scan.csv", "--table", "link.csv"},
                                             {"fit", "link.csv", "--table", "scan.csv"},
                                             {"fit", "scan.csv", "--recipe", "r.toml", "-o", "r.toml"},
                                             {"simulate", "m.json", "--sampling", "hemisphere", "-o", "m.json"},
                                             {"eval", "m.json", "scan.csv", "-o", "scan.csv"},
                                             {"eval", "m.json", "scan.csv", "-o", "m.json"},
                                             {"export", "m.json", "--format", "csv", "-o", "m.json"}}) {
    const Outcome outcome = run_here(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments.front() << ' ' << arguments.back();
    EXPECT_NE(outcome.err.find("is an input of this command"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(content("scan.csv"), scan);
  EXPECT_EQ(content("m.json"), material);
  EXPECT_EQ(content("r.toml"), "components = [\"dd\", \"uds\"]\n");
}

TEST_F(Outputs, TwoOutputsOfOneName) {
  const Outcome outcome = run_here({"fit", "scan.csv", "-o", "x", "--table", "./x"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("two outputs have this name"), std::string::npos) << outcome.err;
  EXPECT_EQ(files(), before_);
}

TEST_F(Outputs, NoGnuplotIsASystemFailureAfterTheMaterialIsSafe) {
  const Outcome outcome =
      run_here({"fit", "scan.csv", "-o", "fitted.json", "--plot", "p.svg"}, {.environment = {"PATH=/nowhere"}});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("gnuplot is not installed"), std::string::npos);
  EXPECT_EQ(read_material(folder_ / "fitted.json").channels.size(), 3U);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "p.svg"));
}

TEST_F(Outputs, ProfilesAndResiduals) {
  const Outcome fitted = run_here({"fit", "scan.csv", "--components", "dd,uds", "--profile", "slope,R.k_dd", "--json",
                                   "-o", "fitted.json", "--profile-plot", "p.svg", "--residual-plot", "r.png"});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const auto profiles = nlohmann::json::parse(fitted.out).at("profiles");
  ASSERT_EQ(profiles.size(), 2U);
  EXPECT_EQ(profiles[0].at("name"), "slope");
  EXPECT_EQ(profiles[1].at("channel"), "R");
  EXPECT_GE(profiles[0].at("points").size(), 7U);
  const Interval slope = read_material(folder_ / "fitted.json").fit->interval_95.at("slope");
  EXPECT_EQ(profiles[0].at("interval_95"), (nlohmann::json{slope.lower, slope.upper}));
  EXPECT_NE(content("p.svg").find("R.k_dd"), std::string::npos);
  EXPECT_EQ(content("r.png").substr(1, 3), "PNG");
  const Outcome text = run_here({"fit", "scan.csv", "--components", "dd,uds", "--profile"});
  EXPECT_NE(text.out.find("95 % by profile"), std::string::npos) << text.out;
}

TEST_F(Outputs, DashIsStandardOutput) {
  const Outcome fitted = run_here({"fit", "scan.csv", "-o", "-"});
  EXPECT_EQ(fitted.status, 0);
  EXPECT_EQ(parse_material(fitted.out, "stdout").channels.size(), 3U);
  EXPECT_NE(fitted.err.find("converged     yes"), std::string::npos) << "the report steps aside";
  EXPECT_EQ(run_here({"fit", "scan.csv", "-o", "-", "--quiet"}).err, "");
  EXPECT_EQ(run_here({"eval", "m.json", "scan.csv", "-o", "-"}).out, run_here({"eval", "m.json", "scan.csv"}).out);
  EXPECT_EQ(files(), before_) << "no file is called -";
}

TEST_F(Outputs, StandardErrorIsSilentWithoutATerminal) {
  EXPECT_EQ(run_here({"fit", "scan.csv", "-o", "fitted.json"}).err, "");
  EXPECT_EQ(run_here({"verify", "--random", "1"}).err, "");
  EXPECT_EQ(run_here({"export", "m.json", "--format", "exr", "--size", "16", "-o", "m.exr"}).err, "");
}

}  // namespace
}  // namespace goniofit::test
