#include <algorithm>
#include <map>
#include <optional>
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
    "k_dd,u_k_dd,k_udf,u_k_udf,k_uds,u_k_uds,k_fs,u_k_fs,solid_angle_sr,loss,rms,samples,converged,"
    "model,rough_form,anisotropy,slope_y,u_slope_y,tau_y_um,u_tau_y_um,tail,u_tail,"
    "facet_slope_deg,u_facet_slope_deg,rho,u_rho";

// What the peers among the materials have of their own, in the order in which they come.
struct PeerColumns {
  std::vector<std::string> parameters, coefficients;

  explicit PeerColumns(const std::vector<Material>& materials) {
    const auto add = [](std::vector<std::string>& names, const std::string& name) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    for (const Material& material : materials) {
      for (const auto& [name, value] : material.parameters) add(parameters, name);
      for (const MaterialChannel& channel : material.channels) {
        for (const auto& [name, value] : channel.peer_k) add(coefficients, name);
      }
    }
  }

  [[nodiscard]] std::string header() const {
    std::string text;
    for (const auto* names : {&parameters, &coefficients}) {
      for (const std::string& name : *names) text += "," + name + ",u_" + name;
    }
    return text;
  }
};

std::string components_text(EffectSet components) {
  std::string out;
  for (const Effect e : all_effects) {
    if (!components.has(e)) continue;
    if (!out.empty()) out += ' ';
    out += name_of(e);
  }
  return out;
}

// A peer reads one term and has no form.
std::string terms_text(const Material& material) {
  const Terms& terms = material.terms;
  const std::string fresnel = "fresnel=" + std::string(name_of(terms.fresnel));
  if (material.model != surface_model) return fresnel;
  return fresnel + " shadowing=" + std::string(name_of(terms.shadowing)) +
         " effective_roughness=" + std::string(name_of(terms.effective_roughness)) +
         " distribution=" + std::string(name_of(terms.distribution));
}

template <class Form>
std::string_view form_text(const Material& material, Form form) {
  return material.model == surface_model ? name_of(form) : std::string_view{};
}

const std::map<std::string, double>* channel_uncertainty(const Material& material, const MaterialChannel& channel) {
  if (!material.fit) return nullptr;
  const auto found = material.fit->channel_uncertainty.find(channel.name);
  return found == material.fit->channel_uncertainty.end() ? nullptr : &found->second;
}

void add_published(Row& row, const Material& material, const MaterialChannel& channel,
                   const std::map<std::string, double>* own, const std::map<std::string, double>* shared) {
  row.add_text(material.name);
  row.add_text(channel.name);
  row.add_number(channel.wavelength_um);
  row.add_parameter(channel.n, own, "n");
  row.add_number(channel.kappa);
  row.add_parameter(channel.f0, own, "f0");
  row.add_text(components_text(material.components));
  row.add_text(terms_text(material));
  row.add_text(form_text(material, material.forms.fs));
  row.add_parameter(material.surface.slope, shared, "slope");
  row.add_parameter(material.surface.sigma_um, shared, "sigma_um");
  row.add_parameter(material.surface.tau_um, shared, "tau_um");
  for (const Coefficient c : {Coefficient::k_dd, Coefficient::k_udf, Coefficient::k_uds, Coefficient::k_fs}) {
    row.add_parameter(channel.coefficient(c), own, name_of(c));
  }
  row.add_number(material.solid_angle_sr);
  row.add_number(material.fit ? std::optional(material.fit->loss) : std::nullopt);
  row.add_number(material.fit ? std::optional(material.fit->rms) : std::nullopt);
  row.add_text(material.fit ? std::to_string(material.fit->samples) : "");
  row.add_text(!material.fit ? "" : material.fit->converged ? "true" : "false");
}

std::string row_text(const Material& material, const MaterialChannel& channel, const PeerColumns& peers) {
  const std::map<std::string, double>* own = channel_uncertainty(material, channel);
  const std::map<std::string, double>* shared = material.fit ? &material.fit->shared_uncertainty : nullptr;
  Row row;
  add_published(row, material, channel, own, shared);
  row.add_text(material.model);
  row.add_text(form_text(material, material.forms.rough));
  row.add_text(form_text(material, material.forms.anisotropy));
  Surface surface = material.surface;
  for (const std::string_view name : {"slope_y", "tau_y_um", "tail", "facet_slope_deg"}) {
    row.add_parameter(*surface.find(name), shared, name);
  }
  row.add_parameter(channel.coefficient(Coefficient::rho), own, name_of(Coefficient::rho));
  for (const std::string& name : peers.parameters) {
    const auto found = material.parameters.find(name);
    row.add_parameter(found == material.parameters.end() ? std::nullopt : found->second, shared, name);
  }
  for (const std::string& name : peers.coefficients) {
    const auto found = channel.peer_k.find(name);
    row.add_parameter(found == channel.peer_k.end() ? std::nullopt : found->second, own, name);
  }
  return row.line();
}

}  // namespace

std::string to_csv(const std::vector<Material>& materials) {
  const PeerColumns peers(materials);
  std::string out = std::string(header) + peers.header() + '\n';
  for (const Material& material : materials) {
    for (const MaterialChannel& channel : material.channels) out += row_text(material, channel, peers);
  }
  return out;
}

}  // namespace goniofit
