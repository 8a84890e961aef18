#include "peers/schlick.h"

#include "peers/schlick_basis.h"
#include "support/error.h"

namespace goniofit {

namespace {

void require_solid_angle(double solid_angle_sr) {
  if (!(solid_angle_sr >= 0.0)) throw usage_error("the solid angle of a mirror cone is 0 or more");
}

// r is a lobe's width squared: twice the step of a width. p scales the lobe's two widths against each other.
std::vector<ShapeParameter> layer_parameters(SchlickAzimuth form, const std::string& number) {
  std::vector<ShapeParameter> shape{{"r" + number, "", 1e-5, 1.0, 0.0, 0.4}};
  if (form == SchlickAzimuth::isotropic) return shape;
  shape.push_back({"p" + number, "", 0.01, 1.0, 0.0, 0.3});
  shape.back().probes = {0.05, 0.2, 0.5, 1.0};
  return shape;
}

template <class Model>
std::unique_ptr<const Basis> single(SchlickAzimuth form, double solid_angle_sr) {
  return std::make_unique<SchlickBasis<Model>>(
      std::vector<BasisCoefficient>{{"C", 0.0, 1.0}, {"white", 1.0, 1.0}},
      std::vector<BasisColumn>{{0, OpticsFactor::one, true}, {1, OpticsFactor::one, true}}, layer_parameters(form, ""),
      solid_angle_sr);
}

template <class Model>
std::unique_ptr<const Basis> layered(SchlickAzimuth form, double solid_angle_sr) {
  std::vector<ShapeParameter> shape = layer_parameters(form, "_1");
  for (ShapeParameter& parameter : layer_parameters(form, "_2")) shape.push_back(std::move(parameter));
  shape[shape.size() / 2].probes = {0.003, 0.01, 0.03, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0};  // the covered layer's r
  return std::make_unique<SchlickBasis<Model>>(
      std::vector<BasisCoefficient>{{"clear", 1.0, 1.0}, {"C_2", 0.0, 1.0}, {"white", 1.0, 1.0}},
      std::vector<BasisColumn>{
          {0, OpticsFactor::fresnel, true}, {1, OpticsFactor::remainder, true}, {2, OpticsFactor::remainder, true}},
      std::move(shape), solid_angle_sr);
}

}  // namespace

std::unique_ptr<const Basis> make_schlick_single(SchlickAzimuth form, double solid_angle_sr) {
  require_solid_angle(solid_angle_sr);
  switch (form) {
    case SchlickAzimuth::isotropic:
      return single<SchlickSingle<SchlickAzimuth::isotropic>>(form, solid_angle_sr);
    case SchlickAzimuth::normalised:
      return single<SchlickSingle<SchlickAzimuth::normalised>>(form, solid_angle_sr);
    case SchlickAzimuth::printed:
      return single<SchlickSingle<SchlickAzimuth::printed>>(form, solid_angle_sr);
  }
  return nullptr;
}

std::unique_ptr<const Basis> make_schlick_double(SchlickAzimuth form, double solid_angle_sr) {
  require_solid_angle(solid_angle_sr);
  switch (form) {
    case SchlickAzimuth::isotropic:
      return layered<SchlickDouble<SchlickAzimuth::isotropic>>(form, solid_angle_sr);
    case SchlickAzimuth::normalised:
      return layered<SchlickDouble<SchlickAzimuth::normalised>>(form, solid_angle_sr);
    case SchlickAzimuth::printed:
      return layered<SchlickDouble<SchlickAzimuth::printed>>(form, solid_angle_sr);
  }
  return nullptr;
}

}  // namespace goniofit
