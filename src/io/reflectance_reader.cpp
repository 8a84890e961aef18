#include "io/reflectance_reader.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/csv_reader.h"
#include "io/line_reader.h"
#include "io/number.h"
#include "support/error.h"
#include "support/text.h"

namespace goniofit {

namespace {

constexpr double largest_reflectance = 1.1;

struct Column {
  enum class Role : std::uint8_t { theta_i, value, uncertainty } role = Role::value;
  std::size_t channel = 0;
};

Error header_error(const CsvReader& csv, const std::string& name, const std::string& what) {
  return input_error(csv.source(), csv.header_line(), shown(name), what);
}

std::optional<std::string> uncertain_channel(const std::string& lower_name) {
  return lower_name.starts_with("u_") ? std::optional(lower_name.substr(2)) : std::nullopt;
}

// Values first: an uncertainty may stand before its channel.
std::vector<Column> find_columns(const CsvReader& csv, ReflectanceReadings& out) {
  std::vector<Column> columns(csv.names().size());
  std::map<std::string, std::size_t> channels;
  std::map<std::string, std::size_t> seen;
  for (std::size_t c = 0; c < csv.names().size(); ++c) {
    const std::string name = lower_case(csv.names()[c]);
    if (!seen.emplace(name, c).second) throw header_error(csv, csv.names()[c], "is there twice");
    if (name == "theta_i") {
      columns[c].role = Column::Role::theta_i;
    } else if (!uncertain_channel(name)) {
      columns[c].channel = out.channels.size();
      channels[name] = out.channels.size();
      out.channels.push_back({csv.names()[c], {}, {}});
    }
  }
  if (!seen.contains("theta_i")) throw header_error(csv, "theta_i", "is missing; expected theta_i and channels");
  if (channels.empty()) throw header_error(csv, "theta_i", "stands alone; expected channels beside it, such as R,G,B");
  for (std::size_t c = 0; c < csv.names().size(); ++c) {
    const auto of = uncertain_channel(lower_case(csv.names()[c]));
    if (!of) continue;
    const auto channel = channels.find(*of);
    if (channel == channels.end()) {
      throw header_error(csv, csv.names()[c], "is the uncertainty of no channel; expected u_ and a channel's name");
    }
    columns[c] = {Column::Role::uncertainty, channel->second};
  }
  return columns;
}

double read_checked(const CsvReader& csv, std::size_t column, std::string_view expected, bool (*holds)(double)) {
  const double value = csv.number(column, expected);
  if (holds(value)) return value;
  throw csv.row_error(column, in_quotes(csv.field(column)) + " is out of range; expected " + std::string(expected));
}

void read_row(const CsvReader& csv, const std::vector<Column>& columns, ReflectanceReadings& out) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    ReflectanceChannel* const channel = out.channels.data() + columns[c].channel;
    switch (columns[c].role) {
      case Column::Role::theta_i:
        out.theta_i_deg.push_back(
            read_checked(csv, c, "degrees from 0 to below 90", [](double x) { return x >= 0.0 && x < 90.0; }) + 0.0);
        break;
      case Column::Role::value:
        channel->values.push_back(read_checked(csv, c, "a reflectance from 0 to 1",
                                               [](double x) { return x >= 0.0 && x <= largest_reflectance; }));
        break;
      case Column::Role::uncertainty:
        channel->u.push_back(read_checked(csv, c, "a standard uncertainty above 0", [](double x) { return x > 0.0; }));
        break;
    }
  }
}

}  // namespace

ReflectanceReadings read_reflectances(std::istream& in, const std::string& source) {
  CsvReader csv(in, source, "names such as theta_i,R,G,B");
  ReflectanceReadings out;
  out.source = source;
  const std::vector<Column> columns = find_columns(csv, out);
  while (csv.next_row()) read_row(csv, columns, out);
  if (out.theta_i_deg.empty())
    throw input_error(source, csv.header_line(), "", "there is no row after the header line; expected one a reading");
  return out;
}

ReflectanceReadings read_reflectances(const std::filesystem::path& path) {
  std::ifstream in = open_input(path);
  return read_reflectances(in, path.string());
}

}  // namespace goniofit
