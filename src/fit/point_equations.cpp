#include "fit/point_equations.h"

namespace goniofit {

namespace {

bool same(const FitPoint& a, const FitPoint& b) {
  return a.z == b.z && a.coefficients == b.coefficients && a.optics == b.optics;
}

void add(const Problem& problem, Model& model, const FitPoint& point, PointEquations& to) {
  model.set_shape(point.z.data(), true);
  to.channels.resize(problem.channels.size());
  for (std::size_t c = 0; c < to.channels.size(); ++c) {
    if (!point.optics.empty()) model.set_optics(c, point.optics[c]);
    ChannelEquations own = model.equations(c, point.coefficients[c]);
    ChannelEquations& sum = to.channels[c];
    to.loss += own.loss;
    sum.loss += own.loss;
    if (sum.products.size() == 0) {
      sum.products = std::move(own.products);
    } else {
      sum.products += own.products;
    }
  }
}

}  // namespace

const PointEquations& EquationsAt::at(const FitPoint& point) {
  if (!equations_.channels.empty() && same(point, point_)) return equations_;
  equations_ = {};
  if (problem_.by_parts()) {
    problem_.for_each_part([&](const Problem& part) {
      Model own(part);
      add(part, own, point, equations_);
    });
  } else {
    add(problem_, model_, point, equations_);
  }
  point_ = point;
  return equations_;
}

}  // namespace goniofit
