#include "report/page.h"

#include <string_view>

#include <ceres/version.h>
#include <fmt/format.h>
#include <Eigen/Core>

#include "report/digest.h"
#include "report/page_template.h"

namespace goniofit {
namespace {

std::string html_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

// Within a script element only '<' can end the data; in JSON it stands in strings alone, where its code is the same.
std::string without_tags(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

PageSource::Input page_input(const std::string& role, const std::string& file) {
  return {role, file, sha256_of_file(file)};
}

std::vector<std::pair<std::string, std::string>> library_versions() {
  return {{"goniofit", GONIOFIT_VERSION},
          {"Ceres", CERES_VERSION_STRING},
          {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)}};
}

std::string report_page(const FitResult& result, const Scan& scan, const PageSource& source) {
  const std::string& name = result.material.name;
  std::string page(page_template.head);
  page += html_escaped((name.empty() ? "Fit" : name) + " – goniofit report");
  page += page_template.middle;
  page += without_tags(page_data(result, scan, source));
  page += page_template.tail;
  return page;
}

}  // namespace goniofit
