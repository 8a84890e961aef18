#include <goniofit/brdf/sampler.h>
#include <goniofit/fit/comparison.h>
#include <goniofit/fit/fit.h>
#include <goniofit/io/scan_reader.h>
#include <goniofit/peers/peers.h>
#include <goniofit/peers/rational_fraction.h>
#include <goniofit/peers/schlick_sampling.h>
#include <goniofit/report/comparison_report.h>
#include <goniofit/report/page.h>
#include <goniofit/terms/effective_roughness.h>
#include <goniofit/terms/fresnel.h>
#include <goniofit/terms/he_torrance.h>
#include <goniofit/terms/oren_nayar.h>
#include <goniofit/terms/shadowing.h>
#include <goniofit/terms/student_t_shadowing.h>
#include <goniofit/terms/v_cavity_integral.h>

#include <iostream>

int main(int, char** argv) {
  const goniofit::Scan scan = goniofit::read_scan(argv[1]);
  const goniofit::FitResult result = goniofit::fit(scan, {});
  std::cout << "slope " << result.material.surface.slope.value() << '\n';

  const goniofit::Evaluator evaluator(result.material);
  const goniofit::Direction light = goniofit::direction_of(40.0, 0.0);
  const auto sample = goniofit::Sampler(evaluator).sample(light, {0.1, 0.3, 0.7});
  std::cout << "pdf " << (sample && sample->pdf > 0.0 ? "positive" : "missing") << '\n';
  std::cout << "peers " << goniofit::peer_catalogue().size() << '\n';
  std::cout << "page " << (goniofit::report_page(result, scan, {}).size() > 1'000'000 ? "whole" : "missing") << '\n';
}
