#include "brdf/block_loops.h"
#include "peers/blinn_phong.h"
#include "peers/cook_torrance.h"
#include "peers/ggx.h"
#include "peers/neumann_neumann.h"
#include "peers/ward.h"
#include "support/lane_math.h"
#include "support/vectorised.h"

namespace goniofit::block {

namespace {

// The lobe is column 1, column 0 the Lambert part.
template <class Real, class Model>
struct PeerLobe {
  using Arguments = PeerArguments<Real>;

  [[gnu::always_inline]] static void run(const Arguments& a) {
    using T = Lane<Real>;
    // Fields that the model does not read are not there; the loads of their stand-in are dropped as unused.
    const auto array = [&](Field f) -> const Real* { return a.g[f] != nullptr ? a.g[f] : a.t->shadowing.data(); };
    const Real* const cos_i = array(Field::cos_i);
    const Real* const cos_r = array(Field::cos_r);
    const Real* const one_minus_cos_i = array(Field::one_minus_cos_i);
    const Real* const one_minus_cos_r = array(Field::one_minus_cos_r);
    const Real* const s_z = array(Field::s_z);
    const Real* const s_h2 = array(Field::s_h2);
    const Real* const tan2_b = array(Field::tan2_b);
    const Real* const mirror_distance2 = array(Field::mirror_distance2);
    Real* const dd = a.t->dd.data();
    const T z = a.z;
    const std::size_t n = a.n;
#pragma GCC ivdep
    for (std::size_t k = 0; k < n; ++k) {
      BasicPair<T> p{};
      p.cos_i = cos_i[k];
      p.cos_r = cos_r[k];
      p.one_minus_cos_i = one_minus_cos_i[k];
      p.one_minus_cos_r = one_minus_cos_r[k];
      p.s_z = s_z[k];
      p.s_h2 = s_h2[k];
      p.tan2_b = tan2_b[k];
      p.mirror_distance2 = mirror_distance2[k];
      std::array<T, 2> values{};
      Model::template factors<T>(p, &z, values.data());
      dd[k] = lane::at_most(most_shape<Real>, values[1].v);
    }
  }
};

struct PeerRow {
  std::string_view model;
  Fields fields;
};
using enum Field;
constexpr std::array peer_rows{PeerRow{"lambert", {}},
                               PeerRow{"blinn-phong", {tan2_b}},
                               PeerRow{"neumann-neumann", {mirror_distance2}},
                               PeerRow{"ward", {tan2_b}},
                               PeerRow{"cook-torrance", {tan2_b, s_z, s_h2}},
                               PeerRow{"ggx", {tan2_b, one_minus_cos_i, one_minus_cos_r}}};

}  // namespace

std::optional<Fields> peer_fields(std::string_view model) {
  for (const PeerRow& row : peer_rows) {
    if (row.model == model) return row.fields;
  }
  return std::nullopt;
}

template <class Real>
Loop<PeerArguments<Real>> peer_lobe(std::string_view model, InstructionSet set) {
  if (model == "blinn-phong") return Vectorised<PeerLobe<Real, BlinnPhong>>::of(set);
  if (model == "neumann-neumann") return Vectorised<PeerLobe<Real, NeumannNeumann>>::of(set);
  if (model == "ward") return Vectorised<PeerLobe<Real, Ward>>::of(set);
  if (model == "cook-torrance") return Vectorised<PeerLobe<Real, CookTorrance>>::of(set);
  return Vectorised<PeerLobe<Real, Ggx>>::of(set);
}

template Loop<PeerArguments<double>> peer_lobe(std::string_view, InstructionSet);
template Loop<PeerArguments<float>> peer_lobe(std::string_view, InstructionSet);

}  // namespace goniofit::block
