// Whatever is wrong with a file, the program ends with status 2 and a message that names place and cause, prints no
// result and writes no file.

#include "cli/program_test.h"

namespace goniofit::test {
namespace {

struct Bad {
  std::string what, content, message;  // the message, or the part of it that matters
};

void expect_refused(const Outcome& outcome, const std::string& what, const std::string& message) {
  EXPECT_EQ(outcome.status, 2) << what << ": " << outcome.err;
  EXPECT_EQ(outcome.out, "") << what;
  EXPECT_NE(outcome.err.find(message), std::string::npos) << what << ": " << outcome.err;
  EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << what << ": one line, " << outcome.err;
}

class BadInput : public ProgramTest {};

TEST_F(BadInput, Scans) {
  const std::string head = "theta_i,theta_r,R\n";
  const std::vector<Bad> cases{
      {"empty file", "", "s.csv: "},
      {"comments only", "# name: x\n", "s.csv: "},
      {"header only", head, "s.csv:1: "},
      {"no theta_i", "theta_r,R\n10,1\n", "theta_i"},
      {"no theta_r", "theta_i,R\n10,1\n", "theta_r"},
      {"no channel", "theta_i,theta_r\n10,10\n", "s.csv:1: "},
      {"phi_i without phi_r", "theta_i,phi_i,theta_r,R\n10,0,10,1\n", "phi_r"},
      {"unknown column", "theta_i,theta_r,R,foo_bar\n10,10,1,1\n", "s.csv:1: column foo_bar: "},
      {"duplicated column", "theta_i,theta_r,R,r\n10,10,1,1\n", "s.csv:1: column r: "},
      {"duplicated angle", "theta_i,theta_i,theta_r,R\n10,10,10,1\n", "s.csv:1: column theta_i: "},
      {"uncertainty without channel", "theta_i,theta_r,R,u_G\n10,10,1,1\n", "u_G"},
      {"not a number", head + "10,10,abc\n", "s.csv:2: column R: "},
      {"trailing text", head + "10,10,1.5x\n", "s.csv:2: column R: "},
      {"decimal comma", "theta_i;theta_r;R\n10;10;1,5\n", "s.csv:2: column R: "},
      {"NaN", head + "10,10,1\n20,20,nan\n", "s.csv:3: column R: "},
      {"infinity", head + "10,10,inf\n", "s.csv:2: column R: "},
      {"overflow", head + "10,10,1e999\n", "s.csv:2: column R: "},
      {"angle NaN", head + "nan,10,1\n", "s.csv:2: column theta_i: "},
      {"theta_i above 90", head + "90.5,10,1\n", "s.csv:2: column theta_i: "},
      {"theta_r below -90", head + "10,-91,1\n", "s.csv:2: column theta_r: "},
      {"negative theta_i", head + "-10,10,1\n", "s.csv:2: column theta_i: "},
      {"short row", head + "10,10,1\n20,20\n", "s.csv:3: "},
      {"long row", head + "10,10,1,7\n", "s.csv:2: "},
      {"empty cell", head + "10,,1\n", "s.csv:2: column theta_r: "},
      {"negative uncertainty", "theta_i,theta_r,R,u_R\n10,10,1,-1\n", "s.csv:2: column u_R: "},
      {"bad refractive_index", "# refractive_index: glass\n" + head + "10,10,1\n", "s.csv:1: "},
      {"wavelengths that do not match", "# wavelength_um: 0.6,0.5\n" + head + "10,10,1\n", "s.csv:1: "},
      {"bad solid angle", "# solid_angle_sr: -1\n" + head + "10,10,1\n", "s.csv:1: "},
      {"binary", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), "s.csv:"},
      {"JSON", "{\"name\": 1}\n", "s.csv:"},
  };
  for (const Bad& bad : cases) {
    add("s.csv", bad.content);
    expect_refused(run_here({"inspect", "s.csv"}), "inspect: " + bad.what, bad.message);
    expect_refused(run_here({"fit", "s.csv", "-o", "m.json", "--plot", "p.svg"}), "fit: " + bad.what, bad.message);
    EXPECT_EQ(files(), std::vector<std::string>{"s.csv"}) << bad.what;
  }
}

TEST_F(BadInput, Recipes) {
  const std::vector<Bad> cases{
      {"syntax", "components = [\"dd\"\n", "r.toml:"},
      {"unknown key", "colour = 1\n", "r.toml: /colour: "},
      {"unknown component", "components = [\"dd\", \"xx\"]\n", "r.toml: /components/1: "},
      {"wrong type", "components = 3\n", "r.toml: /components: "},
      {"unknown tier", "[terms]\nfresnel = \"fast\"\n", "r.toml: /terms/fresnel: "},
      {"unknown model", "model = \"phong\"\n", "r.toml: /model: "},
      {"a peer's components", "model = \"ward\"\ncomponents = [\"dd\"]\n", "r.toml: /components: "},
      {"unknown loss", "loss = \"huber\"\n", "r.toml: /loss: "},
      {"unknown parameter", "[parameters]\nk_xx = 1\n", "r.toml: /parameters/k_xx: "},
      {"crossed bounds", "[parameters]\nk_fs = {min = 2, max = 1}\n", "r.toml: /parameters/k_fs"},
      {"negative n", "[optics]\nn = -1.5\n", "r.toml: /optics/n: "},
      {"n beside f0", "[optics]\nn = 1.5\nf0 = 0.04\n", "r.toml: /optics/"},
      {"missing scan", "scan = \"nowhere.csv\"\n", "nowhere.csv"},
      {"missing constants", "scan = \"s.csv\"\n[optics]\noptical_constants = \"none.csv\"\n", "none.csv"},
  };
  add_scan("s.csv");
  for (const Bad& bad : cases) {
    add("r.toml", bad.content);
    const std::vector<std::string> before = files();
    std::vector<std::string> arguments{"fit", "--recipe", "r.toml", "-o", "m.json"};
    if (bad.content.find("scan =") == std::string::npos) arguments.emplace_back("s.csv");
    expect_refused(run_here(arguments), bad.what, bad.message);
    EXPECT_EQ(files(), before) << bad.what;
  }
  add("r.toml", "components = [\"dd\"]\n");
  expect_refused(run_here({"verify", "r.toml"}), "no [verify]", "r.toml: /verify: ");
}

TEST_F(BadInput, Materials) {
  // `valid` with one text in place of another.
  const std::string valid = R"({"format": "goniofit-material", "version": 1, "name": "x", "components": ["dd"],
  "surface": {"slope": 0.1},
  "channels": [{"name": "R", "n": 1.5, "kappa": 0.0, "k_dd": 0.5}]})";
  const auto with = [&valid](const std::string& old, const std::string& replacement) {
    std::string text = valid;
    return text.replace(text.find(old), old.size(), replacement);
  };
  const std::vector<Bad> cases{
      {"empty", "", "m.json"},
      {"syntax", "{\"format\": ", "m.json:1:"},
      {"an array", "[]", "m.json: "},
      {"another format", with("goniofit-material", "other"), "m.json: /format: "},
      {"a later version", with("\"version\": 1", "\"version\": 99"), "m.json: /version: "},
      {"unknown component", with("\"dd\"", "\"zz\""), "m.json: /components/0: "},
      {"no components", with("[\"dd\"]", "[]"), "m.json: /components: "},
      {"slope 0", with("0.1", "0"), "m.json: /surface/slope: "},
      {"slope as text", with("0.1", "\"a\""), "m.json: /surface/slope: "},
      {"slope against sigma and tau", with("\"slope\": 0.1", "\"slope\": 0.1, \"sigma_um\": 1, \"tau_um\": 5"),
       "m.json: /surface/slope: "},
      {"no slope", with("\"slope\": 0.1", ""), "m.json: /surface/slope: "},
      {"no n", with("\"n\": 1.5, \"kappa\": 0.0, ", ""), "m.json: /channels/0/n: "},
      {"negative coefficient", with("0.5}", "-0.5}"), "m.json: /channels/0/k_dd: "},
      {"huge number", with("0.5}", "1e999}"), "m.json"},
      {"coh without sigma", with("[\"dd\"]", "[\"coh\"]"), "m.json: /surface/sigma_um: "},
      {"unknown key", with("\"k_dd\"", "\"k_ddd\""), "m.json: /channels/0/k_ddd: "},
      {"unknown model", with("\"name\": \"x\"", "\"model\": \"phong\""), "m.json: /model: "},
      {"a peer with effects", with("\"name\": \"x\"", "\"model\": \"ward\""), "m.json: /surface: "},
      {"tail of 1", with("\"slope\": 0.1", "\"slope\": 0.1, \"tail\": 1"), "m.json: /surface/tail: "},
  };
  add("d.csv", "theta_i,theta_r\n10,10\n");
  add("m.json", valid);
  ASSERT_EQ(run_here({"eval", "m.json", "d.csv"}).status, 0) << "what the cases differ from";
  for (const Bad& bad : cases) {
    add("m.json", bad.content);
    expect_refused(run_here({"eval", "m.json", "d.csv", "-o", "out.csv"}), "eval: " + bad.what, bad.message);
    expect_refused(run_here({"simulate", "m.json", "--sampling", "hemisphere", "-o", "out.csv"}),
                   "simulate: " + bad.what, bad.message);
    expect_refused(run_here({"export", "m.json", "--format", "csv", "-o", "out.csv"}), "export: " + bad.what,
                   bad.message);
    EXPECT_EQ(files(), (std::vector<std::string>{"d.csv", "m.json"})) << bad.what;
  }
}

TEST_F(BadInput, Directions) {
  add_material();
  for (const Bad& bad : std::vector<Bad>{{"empty", "", "d.csv"},
                                         {"no angle", "a,b\n1,2\n", "d.csv"},
                                         {"above 90", "theta_i,theta_r\n10,10\n10,95\n", "d.csv:3: column theta_r: "},
                                         {"not a number", "theta_i,theta_r\nten,10\n", "d.csv:2: column theta_i: "},
                                         {"short row", "theta_i,theta_r\n10\n", "d.csv:2: "}}) {
    add("d.csv", bad.content);
    expect_refused(run_here({"eval", "m.json", "d.csv", "-o", "out.csv"}), bad.what, bad.message);
    EXPECT_EQ(files(), (std::vector<std::string>{"d.csv", "m.json"})) << bad.what;
  }
}

TEST_F(BadInput, FlagsThatContradictTheScan) {
  add_scan("s.csv");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--n", "abc"}, "--n: \"abc\" is not a finite number"},
      {{"--n", "1.5,1.6"}, "n: 2 values"},
      {{"--n", "1.5,,1.6"}, "--n: an empty entry"},
      {{"--n", "nan"}, "--n: \"nan\" is not a finite number"},
      {{"--n", "-1"}, "n: -1 is out of range"},
      {{"--n", "1.5", "--f0", "0.04"}, "--f0: stands in place"},
      {{"--n", "1.5", "--optical-constants", "x.csv"}, "--optical-constants: stands in place"},
      {{"--components", "dd,zz"}, "--components: \"zz\", expected auto or some of coh, dd, udf, uds, fs or rough"},
      {{"--components", ""}, "--components"},
      {{"--terms", "fast"}, "--terms: \"fast\", expected li-torrance or he-torrance"},
      {{"--fresnel", "fast"}, "--fresnel: \"fast\", expected schlick, exact or none"},
      {{"--shadowing", "fast"}, "--shadowing: \"fast\""},
      {{"--effective-roughness", "fast"}, "--effective-roughness: \"fast\""},
      {{"--distribution", "fast"}, "--distribution: \"fast\""},
      {{"--fs-form", "fast"}, "--fs-form: \"fast\", expected printed or reciprocal"},
      {{"--rough-form", "fast"}, "--rough-form: \"fast\", expected functional, integral or qualitative"},
      {{"--anisotropy", "fast"}, "--anisotropy: \"fast\", expected consistent or printed"},
      {{"--model", "fast"}, "--model: \"fast\", expected one that `goniofit models` names"},
      {{"--model", "ward", "--components", "dd"}, "--components: the model ward has none of it"},
      {{"--model", "ward", "--shadowing", "smith"}, "--shadowing: the model ward has none of it"},
      {{"--model", "ward", "--anisotropic"}, "--anisotropic: the model ward has none of it"},
      {{"--model", "ward", "--fix", "slope=0.1"},
       "parameter slope: no such parameter, expected one of alpha, k_d, k_s"},
      {{"--fix", "tail=0.5", "--distribution", "student-t"}, "parameter tail: value 0.5 is out of range"},
      {{"--loss", "fast"}, "--loss: \"fast\", expected cosine-l2, inverse-variance, relative, log1p or cube-root"},
      {{"--robust", "fast"}, "--robust: \"fast\", expected none, huber, soft-l1, cauchy or tukey"},
      {{"--robust-scale", "0"}, "--robust-scale: \"0\", expected a number above 0"},
      {{"--loss", "inverse-variance"}, "has no standard uncertainties, expected a column u_"},
      {{"--exclude-retro", "-1"}, "--exclude-retro: \"-1\", expected a number above 0"},
      {{"--exclude-saturated", "fast"}, "--exclude-saturated: \"fast\" is not a finite number"},
      {{"--weight", "fast"}, "--weight: \"fast\", expected cosine, none, cosine-solid-angle or solid-angle"},
      {{"--free", "fast"}, "--free: \"fast\", expected n, f0 or none"},
      {{"--fix", "k_fs"}, "--fix: \"k_fs\", expected NAME=VALUE"},
      {{"--fix", "k_fs="}, "--fix: \"k_fs=\""},
      {{"--fix", "k_fs=x"}, "--fix: \"x\" is not a finite number"},
      {{"--fix", "k_xx=1"}, "k_xx"},
      {{"--fix", "k_fs=1", "--fix", "k_fs=2"}, "--fix: \"k_fs\" is given twice"},
      {{"--fix", "k_fs=1", "--bound", "k_fs=0:2"}, "--bound: \"k_fs\" is given twice"},
      {{"--bound", "slope=0.5"}, "--bound: \"0.5\", expected NAME=MIN:MAX"},
      {{"--bound", "slope=0.5:0.1"}, "slope"},
      {{"--max-theta", "0"}, "--max-theta"},
      {{"--max-theta", "91"}, "--max-theta"},
      {{"--max-theta", "1"}, ""},
      {{"--solid-angle", "0"}, "--solid-angle"},
      {{"--channels", "R,X"}, "no channel 'X'; there are R, G, B"},
      {{"--plot", "p.pdf"}, "p.pdf: a plot is written as .svg or .png"},
      {{"--plot", "-"}, "--plot"},
      {{"--plot", "p.svg", "--plot-axis", "cubic"}, "--plot-axis: \"cubic\", expected auto, linear or log"},
      {{"--profile", "roughness"}, "roughness is no parameter that this fit leaves free, expected some of slope"},
      {{"--profile", "slope,"}, "--profile"},
      {{"--profile", "s.csv"}, "--profile: \"s.csv\" is a file, expected names of parameters"},
      {{"--profile-plot", "p.pdf"}, "p.pdf: a plot is written as .svg or .png"},
      {{"--profile-plot", "-"}, "--profile-plot"},
      {{"--residual-plot", "r.jpeg"}, "r.jpeg: a plot is written as .svg or .png"},
      {{"--residual-plot", "-"}, "--residual-plot"},
      {{"--optical-constants", "missing.csv"}, "missing.csv"},
      {{"-o", "-", "--json"}, "cannot both go to standard output"},
  };
  for (const auto& [flags, message] : cases) {
    std::vector<std::string> arguments{"fit", "s.csv", "--table", "t.csv"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    expect_refused(run_here(arguments), flags.front() + " " + flags.at(1), message);
    EXPECT_EQ(files(), std::vector<std::string>{"s.csv"}) << flags.front() << ' ' << flags.at(1);
  }
}

TEST_F(BadInput, ScansOfDifferentChannels) {
  add("a.csv", "theta_i,theta_r,R\n10,10,1\n");
  add("b.csv", "theta_i,theta_r,G\n10,10,1\n");
  expect_refused(run_here({"fit", "a.csv", "b.csv"}), "channels", "b.csv: channels G; expected R");
}

}  // namespace
}  // namespace goniofit::test
