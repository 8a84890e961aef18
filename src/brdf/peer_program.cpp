#include "brdf/peer_program.h"

#include <algorithm>
#include <cmath>

#include "brdf/evaluator.h"
#include "geometry/angles.h"
#include "peers/peers.h"

namespace goniofit::batch {

namespace {

using block::Use;

double k_of(const MaterialChannel& c, const Basis& basis, std::size_t column) {
  return c.coefficient(basis.coefficients()[basis.columns()[column].coefficient].name).value_or(0.0);
}

}  // namespace

template <class Real>
PeerProgram<Real>::PeerProgram(const Material& material, const CompileSettings& settings)
    : set_(settings.instructions), fields_(*block::peer_fields(material.model)) {
  validate(material, material.name.empty() ? "material" : material.name);
  const std::unique_ptr<const Basis> basis = make_peer(material.model, material.solid_angle_sr);
  if (basis->columns().size() > 1) {
    const ShapeParameter& shape = basis->shape_parameters().front();
    const auto found = material.parameters.find(shape.name);
    const bool known = found != material.parameters.end() && found->second;
    z_ = static_cast<Real>(std::log((known ? *found->second : shape.lower) - shape.origin));
    lobe_ = block::peer_lobe<Real>(material.model, set_);
  }
  plan_channels(material);
  using enum block::Field;
  fields_ |= {cos_i, cos_r};
  if (mirror_ == Use::schlick || mirror_ == Use::array) fields_ |= {cos_h, one_minus_cos_h};
}

template <class Real>
void PeerProgram<Real>::plan_channels(const Material& material) {
  const std::unique_ptr<const Basis> basis = make_peer(material.model, material.solid_angle_sr);
  const FresnelTier tier = material.terms.fresnel;
  const bool lobe = lobe_ != nullptr;
  const bool mirrors = lobe && basis->columns()[1].optics == OpticsFactor::fresnel && tier != FresnelTier::none;
  mirror_ = !lobe ? Use::absent : !mirrors ? Use::constant : tier == FresnelTier::schlick ? Use::schlick : Use::array;
  fresnel_ = block::exact_fresnel<Real>(set_);
  for (const MaterialChannel& c : material.channels) {
    Plan p;
    const double k_s = lobe ? k_of(c, *basis, 1) : 0.0;
    const double f0 = c.normal_reflectance();
    p.diffuse = static_cast<Real>(k_of(c, *basis, 0) / pi);
    p.mirror_0 = static_cast<Real>(mirror_ == Use::schlick ? k_s * f0 : mirror_ == Use::array ? 0.0 : k_s);
    p.mirror_1 = static_cast<Real>(mirror_ == Use::schlick ? k_s * (1.0 - f0) : k_s);
    p.index = static_cast<Real>(c.n.value_or(1.0));
    p.kappa = static_cast<Real>(c.kappa.value_or(0.0));
    p.combine = block::combine<Real, Real>(k_s == 0.0 ? Use::absent : mirror_, Use::absent, false, set_);
    plans_.push_back(p);
  }
}

template <class Real>
template <class Source>
void PeerProgram<Real>::run_blocks(const Source& source, std::span<Real> result) const {
  FieldArrays<Real> fields;
  block::Terms<Real> terms;
  block::Geometry<Real> geometry;
  block::Array<Real> last;
  constexpr Real most = std::is_same_v<Real, float> ? Real(1e30) : Real(saturation);
  for (std::size_t first = 0; first < source.size(); first += block::size) {
    const std::size_t n = std::min(block::size, source.size() - first);
    const std::size_t whole = whole_vectors(n);
    source.prepare(first, n, fields, geometry);
    if (lobe_ != nullptr) lobe_({geometry, &terms, whole, z_});
    for (std::size_t c = 0; c < plans_.size(); ++c) {
      const Plan& p = plans_[c];
      if (mirror_ == Use::array) fresnel_({geometry, &terms, whole, p.index, p.kappa});
      Real* const out = result.data() + c * source.size() + first;
      Real* const to = whole == n ? out : last.data();
      p.combine({geometry, &terms, whole, p.mirror_0, p.mirror_1, Real(0), Real(0), p.diffuse, most, to});
      if (to != out) std::copy_n(to, n, out);
    }
  }
}

template class PeerProgram<double>;
template class PeerProgram<float>;

}  // namespace goniofit::batch
