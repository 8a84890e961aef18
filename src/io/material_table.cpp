#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "io/material_io.h"
#include "support/text.h"

namespace goniofit {

namespace {

// RFC 4180: quotes where the text has a separator, a quote or a line break, inner quotes doubled.
std::string csv_text(std::string_view text) {
  if (text.find_first_of(",;\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

class Row {
 public:
  void add_text(std::string_view text) { add_cell(csv_text(text)); }
  void add_number(const std::optional<double>& value) { add_cell(value ? shortest(*value) : ""); }
  /// The value and, in the column after it, its standard uncertainty.
  void add_parameter(const std::optional<double>& value, const std::map<std::string, double>* u,
                     std::string_view name) {
    add_number(value);
    const bool known = u != nullptr && u->contains(std::string(name));
    add_cell(known ? shortest(u->at(std::string(name))) : "");
  }
  [[nodiscard]] std::string line() const { return line_ + '\n'; }

 private:
  void add_cell(const std::string& cell) {
    if (cells_++ > 0) line_ += ',';
    line_ += cell;
  }

  std::string line_;
  std::size_t cells_ = 0;
};

constexpr std::string_view header =
    "name,channel,wavelength_um,n,u_n,kappa,f0,u_f0,components,terms,fs_form,"
    "slope,u_slope,sigma_um,u_sigma_um,tau_um,u_tau_um,"
    "k_dd,u_k_dd,k_udf,u_k_udf,k_uds,u_k_uds,k_fs,u_k_fs,solid_angle_sr,loss,rms,samples,converged\n";

std::string components_text(EffectSet components) {
  std::string out;
  for (const Effect e : all_effects) {
    if (!components.has(e)) continue;
    if (!out.empty()) out += ' ';
    out += name_of(e);
  }
  return out;
}

std::string terms_text(const Terms& terms) {
  return "fresnel=" + std::string(name_of(terms.fresnel)) + " shadowing=" + std::string(name_of(terms.shadowing)) +
         " effective_roughness=" + std::string(name_of(terms.effective_roughness)) +
         " distribution=" + std::string(name_of(terms.distribution));
}

const std::map<std::string, double>* channel_uncertainty(const Material& material, const MaterialChannel& channel) {
  if (!material.fit) return nullptr;
  const auto found = material.fit->channel_uncertainty.find(channel.name);
  return found == material.fit->channel_uncertainty.end() ? nullptr : &found->second;
}

std::string row_text(const Material& material, const MaterialChannel& channel) {
  const std::map<std::string, double>* own = channel_uncertainty(material, channel);
  const std::map<std::string, double>* shared = material.fit ? &material.fit->shared_uncertainty : nullptr;
  Row row;
  row.add_text(material.name);
  row.add_text(channel.name);
  row.add_number(channel.wavelength_um);
  row.add_parameter(channel.n, own, "n");
  row.add_number(channel.kappa);
  row.add_parameter(channel.f0, own, "f0");
  row.add_text(components_text(material.components));
  row.add_text(terms_text(material.terms));
  row.add_text(name_of(material.fs_form));
  row.add_parameter(material.surface.slope, shared, "slope");
  row.add_parameter(material.surface.sigma_um, shared, "sigma_um");
  row.add_parameter(material.surface.tau_um, shared, "tau_um");
  for (const Coefficient c : all_coefficients) row.add_parameter(channel.coefficient(c), own, name_of(c));
  row.add_number(material.solid_angle_sr);
  row.add_number(material.fit ? std::optional(material.fit->loss) : std::nullopt);
  row.add_number(material.fit ? std::optional(material.fit->rms) : std::nullopt);
  row.add_text(material.fit ? std::to_string(material.fit->samples) : "");
  row.add_text(!material.fit ? "" : material.fit->converged ? "true" : "false");
  return row.line();
}

}  // namespace

std::string to_csv(const std::vector<Material>& materials) {
  std::string out(header);
  for (const Material& material : materials) {
    for (const MaterialChannel& channel : material.channels) out += row_text(material, channel);
  }
  return out;
}

}  // namespace goniofit
