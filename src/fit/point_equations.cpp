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
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (known_[i].equations.channels.empty() || !same(point, known_[i].point)) continue;
    last_ = i;
    return last();
  }
  last_ = 1 - last_;
  PointEquations& to = known_[last_].equations = {};
  if (problem_.by_parts()) {
    problem_.for_each_part([&](const Problem& part) {
      Model own(part);
      add(part, own, point, to);
    });
  } else {
    add(problem_, model_, point, to);
  }
  known_[last_].point = point;
  return to;
}

}  // namespace goniofit
