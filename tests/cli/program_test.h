#pragma once
// A scratch folder with a material and a scan of it, and the program to run on them.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/material_io.h"
#include "io/scan_reader.h"
#include "support/materials.h"
#include "support/run_program.h"
#include "synthetic/simulate.h"

namespace goniofit::test {

class ProgramTest : public ::testing::Test {
 protected:
  /// Runs in the scratch folder, so that messages name files as the test does.
  [[nodiscard]] Outcome run_here(std::vector<std::string> arguments, RunOptions options = {}) const {
    options.folder = folder_.path();
    return goniofit(std::move(arguments), options);
  }
  void add(const std::string& name, const std::string& content) const { spit(folder_ / name, content); }
  [[nodiscard]] std::string content(const std::string& name) const { return slurp(folder_ / name); }
  [[nodiscard]] std::vector<std::string> files() const { return names_in(folder_.path()); }

  void add_material(const std::string& name = "m.json") const { add(name, to_json(garnet_red_paint_13())); }
  /// In the plane of incidence, 2 % noise.
  void add_scan(const std::string& name = "scan.csv") const {
    const Noise noise{.relative = 0.02, .additive = 0.0};
    std::ostringstream out;
    write_scan(out, simulate(garnet_red_paint_13(), Sampling::incidence_plane, noise, 7));
    add(name, out.str());
  }

  ScratchDir folder_;
};

}  // namespace goniofit::test
