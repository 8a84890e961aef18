// goniofit eval: BRDF values at given directions.

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "brdf/evaluator.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/value_warnings.h"
#include "geometry/pair.h"
#include "io/material_io.h"
#include "io/scan_reader.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit::cli {
namespace {

struct Options {
  std::filesystem::path material, directions, output;
};

void check_names(const Material& material, char separator, const std::string& source) {
  for (const MaterialChannel& channel : material.channels) {
    const bool blank = separator == ' ' || separator == '\t';
    const auto breaks = [=](char c) {
      return c == separator || c == '\n' || c == '\r' || (blank && (c == ' ' || c == '\t'));
    };
    if (std::any_of(channel.name.begin(), channel.name.end(), breaks)) {
      throw key_error(source, "/channels",
                      "the name " + in_quotes(channel.name) + " cannot head a column of this table");
    }
  }
}

// The input's columns as they stood, without the trailing separators that would shift those to be added. Only what the
// header has beyond its last name goes: an empty last field of a row is a field.
class RowEnds {
 public:
  RowEnds(const std::string& header, char separator) : separator_(separator), header_(cut(header, 0)) {
    fields_ = count(header_);
  }
  [[nodiscard]] const std::string& header() const { return header_; }
  [[nodiscard]] std::string row(const std::string& line) const { return cut(line, fields_); }

 private:
  [[nodiscard]] bool is_end(char c) const { return c == separator_ || c == ' ' || c == '\t' || c == '\r'; }
  [[nodiscard]] std::size_t count(const std::string& line) const {
    return static_cast<std::size_t>(std::count(line.begin(), line.end(), separator_));
  }
  [[nodiscard]] std::string cut(std::string line, std::size_t fields) const {
    const bool blank = separator_ == ' ' || separator_ == '\t';
    std::size_t left = count(line);
    while (!line.empty() && is_end(line.back())) {
      if (line.back() == separator_ && !blank) {
        if (left <= fields) break;
        --left;
      }
      line.pop_back();
    }
    return line;
  }

  char separator_;
  std::string header_;
  std::size_t fields_ = 0;
};

void write_values(std::ostream& out, const Evaluator& evaluator, const DirectionTable& table) {
  const RowEnds ends(table.header, table.separator);
  std::string line = ends.header();
  for (const MaterialChannel& channel : evaluator.material().channels) line += table.separator + channel.name;
  out << line << '\n';
  for (std::size_t row = 0; row < table.angles.size(); ++row) {
    line = ends.row(table.lines[row]);
    const Pair pair = make_pair(table.angles[row]);
    for (std::size_t c = 0; c < evaluator.channels(); ++c) {
      fmt::format_to(std::back_inserter(line), "{}{:.17g}", table.separator, evaluator.value(pair, c));
    }
    out << line << '\n';
  }
}

int run(const Options& options) {
  check_outputs({options.output}, {options.material, options.directions});
  const Evaluator evaluator(read_material(options.material));
  const DirectionTable table = read_directions(options.directions);
  check_names(evaluator.material(), table.separator, options.material.string());
  write_result(options.output, [&](std::ostream& out) { write_values(out, evaluator, table); });
  warn_of_values(evaluator, table.angles, options.material.string());
  return 0;
}

}  // namespace

void add_eval(CLI::App& program, int& status) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("eval", "BRDF values of a material at given directions");
  command->add_option("MATERIAL", options->material, "material JSON")->type_name("")->required();
  command->add_option("DIRECTIONS", options->directions, "CSV with the angle columns of a scan, in degrees")
      ->type_name("")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "the directions with one column a channel added, 17 significant digits (standard output by default)")
      ->type_name("FILE");
  command->footer("Example:\n  goniofit eval fits/garnet_red_paint_13.json directions.csv -o values.csv");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace goniofit::cli
