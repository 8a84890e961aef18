#include "io/refractive_index_yaml.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "io/number.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr std::size_t formula_samples = 4096;

// One quantity, or two, over ascending wavelengths.
struct Curve {
  std::vector<double> wavelength_um, n, kappa;  // n or kappa may be empty
};

std::size_t line_of(const YAML::Node& node) { return static_cast<std::size_t>(node.Mark().line + 1); }

struct File {
  const std::string& source;
  [[nodiscard]] Error error(std::size_t line, const std::string& what) const {
    return input_error(source, line, "", what);
  }
};

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  constexpr std::string_view blanks = " \t\r";
  for (std::size_t begin = text.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return words;
}

double number_of(const File& file, std::size_t line, std::string_view word, const std::string& key) {
  const ParsedNumber parsed = parse_number(word);
  if (parsed.fault != NumberFault::none) throw file.error(line, key + ": " + describe(parsed.fault, word, "a number"));
  return parsed.value;
}

std::string scalar(const File& file, const YAML::Node& block, const std::string& key) {
  const YAML::Node node = block[key];
  if (!node || !node.IsScalar())
    throw file.error(line_of(block), "the block has no '" + key + "'; expected it beside 'type'");
  return node.Scalar();
}

std::vector<double> numbers(const File& file, const YAML::Node& block, const std::string& key) {
  const std::string text = scalar(file, block, key);
  std::vector<double> values;
  for (const std::string_view word : words_of(text)) values.push_back(number_of(file, line_of(block[key]), word, key));
  return values;
}

void check_row(const File& file, std::size_t line, const Curve& curve) {
  const std::size_t last = curve.wavelength_um.size() - 1;
  const double wavelength = curve.wavelength_um[last];
  if (!(wavelength > 0.0) || (last > 0 && wavelength <= curve.wavelength_um[last - 1])) {
    throw file.error(line, "data: the wavelength is out of order; expected ascending wavelengths above 0");
  }
  if (!curve.n.empty() && !(curve.n[last] > 0.0)) throw file.error(line, "data: n is out of range; expected n above 0");
  if (!curve.kappa.empty() && curve.kappa[last] < 0.0) {
    throw file.error(line, "data: k is out of range; expected k from 0 up");
  }
}

Curve read_table(const File& file, const YAML::Node& block, bool with_n, bool with_kappa) {
  const std::string data = scalar(file, block, "data");
  const std::size_t columns = 1U + (with_n ? 1U : 0U) + (with_kappa ? 1U : 0U);
  Curve curve;
  std::size_t line = line_of(block["data"]);  // of the bar; the text begins below it
  for (std::size_t begin = 0; begin < data.size();) {
    const std::size_t end = std::min(data.find('\n', begin), data.size());
    const std::vector<std::string_view> words = words_of(std::string_view(data).substr(begin, end - begin));
    begin = end + 1;
    ++line;
    if (words.empty()) continue;
    if (words.size() != columns) {
      throw file.error(line, "data: " + std::to_string(words.size()) + " numbers; expected " + std::to_string(columns));
    }
    curve.wavelength_um.push_back(number_of(file, line, words[0], "data"));
    if (with_n) curve.n.push_back(number_of(file, line, words[1], "data"));
    if (with_kappa) curve.kappa.push_back(number_of(file, line, words[columns - 1], "data"));
    check_row(file, line, curve);
  }
  if (curve.wavelength_um.empty())
    throw file.error(line_of(block["data"]), "data: there is no number; expected a table");
  return curve;
}

// Sellmeier: n² = 1 + c0 + sum of b λ²/(λ² - c²), formula 2 with c² itself in place of c.
double sellmeier_n2(const std::vector<double>& c, bool squared, double wavelength_um) {
  const double l2 = wavelength_um * wavelength_um;
  double n2 = 1.0 + c[0];
  for (std::size_t i = 1; i + 1 < c.size(); i += 2) n2 += c[i] * l2 / (l2 - (squared ? c[i + 1] : c[i + 1] * c[i + 1]));
  return n2;
}

Curve tabulate_sellmeier(const File& file, const YAML::Node& block, bool squared) {
  const std::vector<double> c = numbers(file, block, "coefficients");
  const std::vector<double> range = numbers(file, block, "wavelength_range");
  if (c.size() % 2 != 1) {
    throw file.error(line_of(block["coefficients"]),
                     "coefficients: " + std::to_string(c.size()) + " numbers; expected one, and two a term");
  }
  if (range.size() != 2 || !(range[0] > 0.0 && range[1] > range[0])) {
    throw file.error(line_of(block["wavelength_range"]),
                     "wavelength_range: expected two ascending wavelengths above 0");
  }
  Curve curve;
  for (std::size_t i = 0; i < formula_samples; ++i) {
    const double t = static_cast<double>(i) / (formula_samples - 1);
    // Evenly in the logarithm: dispersion is steep at the short end. The ends are met exactly.
    const double wavelength = i == 0                     ? range[0]
                              : i == formula_samples - 1 ? range[1]
                                                         : range[0] * std::pow(range[1] / range[0], t);
    const double n2 = sellmeier_n2(c, squared, wavelength);
    if (!(n2 > 0.0) || !std::isfinite(n2)) {
      throw file.error(line_of(block["coefficients"]),
                       "coefficients: n is not real all over wavelength_range; expected n above 0");
    }
    curve.wavelength_um.push_back(wavelength);
    curve.n.push_back(std::sqrt(n2));
  }
  return curve;
}

Curve read_block(const File& file, const YAML::Node& block) {
  if (!block.IsMap()) throw file.error(line_of(block), "DATA: expected blocks that begin with '- type:'");
  const std::string type = scalar(file, block, "type");
  if (type == "tabulated nk") return read_table(file, block, true, true);
  if (type == "tabulated n") return read_table(file, block, true, false);
  if (type == "tabulated k") return read_table(file, block, false, true);
  if (type == "formula 1") return tabulate_sellmeier(file, block, false);
  if (type == "formula 2") return tabulate_sellmeier(file, block, true);
  throw file.error(line_of(block["type"]), "type " + in_quotes(type) +
                                               " is not supported; expected tabulated nk, tabulated n, tabulated k, "
                                               "formula 1 or formula 2");
}

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto upper = std::lower_bound(x.begin(), x.end(), at);
  const auto i = static_cast<std::size_t>(upper - x.begin());
  if (*upper == at) return y[i];
  return std::lerp(y[i - 1], y[i], (at - x[i - 1]) / (x[i] - x[i - 1]));
}

// Every wavelength of either curve that both span.
OpticalConstants joined(const File& file, const Curve& n, const Curve& kappa) {
  const double first = std::max(n.wavelength_um.front(), kappa.wavelength_um.front());
  const double last = std::min(n.wavelength_um.back(), kappa.wavelength_um.back());
  if (first > last) throw file.error(0, "n and k are given for different wavelengths; expected ranges that overlap");
  OpticalConstants table;
  std::set_union(n.wavelength_um.begin(), n.wavelength_um.end(), kappa.wavelength_um.begin(), kappa.wavelength_um.end(),
                 std::back_inserter(table.wavelength_um));
  std::erase_if(table.wavelength_um, [&](double w) { return w < first || w > last; });
  for (const double w : table.wavelength_um) {
    table.n.push_back(interpolate(n.wavelength_um, n.n, w));
    table.kappa.push_back(interpolate(kappa.wavelength_um, kappa.kappa, w));
  }
  return table;
}

OpticalConstants combine(const File& file, const YAML::Node& data) {
  std::optional<Curve> n, kappa;
  for (const YAML::Node& block : data) {
    Curve curve = read_block(file, block);
    const bool twice = (!curve.n.empty() && n) || (!curve.kappa.empty() && kappa);
    if (twice) throw file.error(line_of(block), "n or k is given twice; expected each once");
    if (!curve.kappa.empty()) kappa = curve;
    if (!curve.n.empty()) n = std::move(curve);
  }
  if (!n)
    throw file.error(line_of(data), "DATA: there is no n; expected a block 'tabulated nk', 'tabulated n' or a formula");
  if (kappa) return joined(file, *n, *kappa);
  std::vector<double> transparent(n->n.size(), 0.0);
  return {.source = {},
          .wavelength_um = std::move(n->wavelength_um),
          .n = std::move(n->n),
          .kappa = std::move(transparent)};
}

}  // namespace

OpticalConstants parse_refractive_index_yaml(const std::string& text, const std::string& source) {
  const File file{source};
  try {
    const YAML::Node root = YAML::Load(text);
    const YAML::Node data = root.IsMap() ? root["DATA"] : YAML::Node(YAML::NodeType::Undefined);
    if (!data || !data.IsSequence())
      throw file.error(0, "there is no list DATA; expected blocks that begin with '- type:'");
    return combine(file, data);
  } catch (const YAML::Exception& fault) {
    const std::size_t line = fault.mark.is_null() ? 0 : static_cast<std::size_t>(fault.mark.line + 1);
    throw file.error(line, "is not YAML: " + fault.msg);
  }
}

}  // namespace goniofit
