#include "cli/page_source.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace goniofit::cli {
namespace {

std::vector<std::string>& remembered() {
  static std::vector<std::string> arguments;
  return arguments;
}

std::string shell_quoted(const std::string& word) {
  const auto plain = [](char c) {
    constexpr std::string_view harmless = "_-./,:=+@%^";
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || harmless.find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

void remember_command(std::vector<std::string> arguments) { remembered() = std::move(arguments); }

std::string command_text(const std::filesystem::path& page) {
  const std::string own = page.string();
  std::string out = "goniofit";
  for (const std::string& word : remembered()) {
    const std::size_t equals = word.find('=');
    const bool assigned = word.starts_with("--") && equals != std::string::npos && word.substr(equals + 1) == own;
    out += ' ' + (word == own ? "PAGE" : assigned ? word.substr(0, equals + 1) + "PAGE" : shell_quoted(word));
  }
  return out;
}

PageSource page_source(const std::filesystem::path& page,
                       const std::vector<std::pair<std::string, std::filesystem::path>>& inputs) {
  PageSource source;
  for (const auto& [role, file] : inputs) source.inputs.push_back(page_input(role, file.string()));
  source.command = command_text(page);
  source.versions = library_versions();
  return source;
}

}  // namespace goniofit::cli
