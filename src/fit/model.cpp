#include "fit/model.h"

#include <ceres/jet.h>

#include <algorithm>

#include "fit/dot.h"
#include "fit/optics_columns.h"

namespace goniofit {

namespace {

using Dual = ceres::Jet<double, 1>;

std::vector<double*> column_pointers(Eigen::MatrixXd& m) {
  std::vector<double*> pointers;
  for (Eigen::Index j = 0; j < m.cols(); ++j) pointers.push_back(m.col(j).data());
  return pointers;
}

}  // namespace

Model::Model(const Problem& problem)
    : problem_(problem),
      states_(problem.channels.size()),
      parameters_(static_cast<Eigen::Index>(problem.basis->shape_parameters().size())) {
  for (std::size_t i = 0; problem.basis->has_length() && i < problem.pairs.size(); ++i) {
    if (problem.basis->reads_length(problem.pairs[i])) late_rows_.push_back(i);
  }
  late_ = problem.pairs.subset(late_rows_);
  const bool fixed = problem.free_optics == FreeOptics::none;
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    // Where no factor reads the wavelength all channels share one set.
    const std::size_t factors = factors_for(problem.basis->has_length() ? problem.wavelength(c) : 1.0);
    std::size_t group = groups_.size();
    for (std::size_t other = 0; fixed && other < c; ++other) {
      const bool shared = problem.channels[other].optics_group == problem.channels[c].optics_group;
      if (shared && groups_[group_[other]].factors == factors) group = group_[other];
    }
    group_.push_back(group);
    if (group < groups_.size()) continue;
    Group& created = groups_.emplace_back();
    created.factors = factors;
    if (fixed) fill_optics(c, created);
  }
}

std::size_t Model::factors_for(double wavelength_um) {
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    if (factors_[f].wavelength_um == wavelength_um) return f;
  }
  const auto n = static_cast<Eigen::Index>(problem_.pairs.size());
  const auto columns = static_cast<Eigen::Index>(problem_.basis->columns().size());
  factors_.push_back({wavelength_um, Eigen::MatrixXd(n, columns), Eigen::MatrixXd::Zero(n, columns * parameters_)});
  return factors_.size() - 1;
}

void Model::fill_optics(std::size_t channel, Group& group) const {
  if (problem_.free_optics == FreeOptics::none) {
    group.optics = optics_columns(problem_, problem_.channels[channel].optics);
    return;
  }
  const std::vector<BasisColumn>& columns = problem_.basis->columns();
  const Eigen::VectorXd& weight = problem_.point_weight;
  const Eigen::Index n = weight.size();
  group.optics.resize(n, static_cast<Eigen::Index>(columns.size()));
  group.optics_derivatives.resize(n, static_cast<Eigen::Index>(columns.size()));
  const BasicOptics<Dual> dual = problem_.optics_at(channel, Dual(group.optics_value, 0));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Pair p = problem_.pairs[static_cast<std::size_t>(i)];
      const Dual factor = optics_factor(columns[j].optics, problem_.terms.fresnel, dual, p);
      group.optics(i, column) = weight[i] * factor.a;
      group.optics_derivatives(i, column) = weight[i] * factor.v[0];
    }
  }
}

void Model::multiply_out(Group& group, bool derivatives) const {
  const Factors& f = factors_[group.factors];
  const auto n = static_cast<std::size_t>(f.values.rows());
  group.squares.clear();
  group.products.resize(f.values.rows(), f.values.cols());
  if (derivatives) group.shape_products.resize(f.derivatives.rows(), f.derivatives.cols());
  for (Eigen::Index j = 0; j < f.values.cols(); ++j) {
    const double* const optics = group.optics.col(j).data();
    multiply(optics, f.values.col(j).data(), group.products.col(j).data(), n);
    if (!derivatives || !problem_.basis->columns()[static_cast<std::size_t>(j)].reads_shape) continue;
    for (Eigen::Index parameter = j * parameters_; parameter < (j + 1) * parameters_; ++parameter) {
      multiply(optics, f.derivatives.col(parameter).data(), group.shape_products.col(parameter).data(), n);
    }
  }
  problem_.sums.apply(group.products);
  if (derivatives) problem_.sums.apply(group.shape_products);
}

void Model::shape_factors(const Eigen::VectorXd& shape, const PairBatch& pairs, double wavelength_um, bool derivatives,
                          Eigen::MatrixXd& values, Eigen::MatrixXd& by_shape) const {
  const std::span<const double> z(shape.data(), static_cast<std::size_t>(parameters_));
  if (derivatives) {
    problem_.basis->shape_factors(pairs, z, wavelength_um, column_pointers(values), column_pointers(by_shape));
  } else {
    problem_.basis->shape_factors(pairs, z, wavelength_um, column_pointers(values));
  }
}

void Model::set_shape(const double* z, bool derivatives) { set_whole_shape(problem_.shape.at(z), derivatives); }

void Model::set_whole_shape(const Eigen::VectorXd& shape, bool derivatives) {
  const bool same = shape_.size() == shape.size() && shape_ == shape && shape.size() > 0;
  if (same && (have_derivatives_ || !derivatives)) return;
  shape_ = shape;
  Eigen::MatrixXd values(static_cast<Eigen::Index>(late_.size()), factors_.front().values.cols());
  Eigen::MatrixXd by_shape = Eigen::MatrixXd::Zero(values.rows(), factors_.front().derivatives.cols());
  for (Factors& f : factors_) {
    if (&f == &factors_.front()) {
      shape_factors(shape, problem_.pairs, f.wavelength_um, derivatives, f.values, f.derivatives);
      continue;
    }
    f.values = factors_.front().values;
    if (derivatives) f.derivatives = factors_.front().derivatives;
    shape_factors(shape, late_, f.wavelength_um, derivatives, values, by_shape);
    for (std::size_t i = 0; i < late_rows_.size(); ++i) {
      const auto from = static_cast<Eigen::Index>(i);
      const auto to = static_cast<Eigen::Index>(late_rows_[i]);
      f.values.row(to) = values.row(from);
      if (derivatives) f.derivatives.row(to) = by_shape.row(from);
    }
  }
  have_derivatives_ = derivatives;
  if (problem_.free_optics != FreeOptics::none) return;  // set_optics multiplies out
  for (Group& group : groups_) multiply_out(group, derivatives);
}

void Model::set_optics(std::size_t channel, double value) {
  if (problem_.free_optics == FreeOptics::none) return;
  Group& group = groups_[group_[channel]];
  if (group.optics.size() == 0 || group.optics_value != value) {
    group.optics_value = value;
    fill_optics(channel, group);
  }
  multiply_out(group, have_derivatives_);
}

double Model::amplitude(Eigen::Index column, const SmallVector& k) const noexcept {
  const BasisColumn& c = problem_.basis->columns()[static_cast<std::size_t>(column)];
  const double value = k[static_cast<Eigen::Index>(c.coefficient)];
  return c.power == 2 ? value * value : value;
}

void Model::emphasise(std::size_t channel, Eigen::Ref<Eigen::VectorXd> out) const {
  const Eigen::VectorXd& slope = states_[channel].slope;
  const Eigen::VectorXd& factor = slope.size() > 0 ? slope : problem_.channels[channel].emphasis;
  if (factor.size() > 0) multiply(factor.data(), out.data(), out.data(), problem_.samples());
}

void Model::add_columns(std::size_t channel, const SmallVector& k, Eigen::VectorXd& out) const {
  const Eigen::MatrixXd& products = groups_[group_[channel]].products;
  for (Eigen::Index j = 0; j < products.cols(); ++j) {
    const double a = amplitude(j, k);
    if (a != 0.0) add_scaled(a, products.col(j).data(), out.data(), problem_.samples());
  }
}

void Model::weighted_values(std::size_t channel, const SmallVector& k, Eigen::VectorXd& out) const {
  out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem_.samples()));
  add_columns(channel, k, out);
}

double Model::residuals(std::size_t channel, const SmallVector& k, Eigen::VectorXd& out) {
  if (!problem_.quadratic()) {
    weighted_values(channel, k, out);
    states_[channel].weighted = out;
    return bend(channel, out);
  }
  out = -problem_.channels[channel].target;
  add_columns(channel, k, out);
  emphasise(channel, out);
  return out.squaredNorm();
}

// From weight * model to residuals, their slopes and the loss.
double Model::bend(std::size_t channel, Eigen::VectorXd& out) {
  const ProblemChannel& c = problem_.channels[channel];
  ChannelState& state = states_[channel];
  state.slope.resize(out.size());
  double loss = 0.0;
  double slopes = 0.0;
  double curvatures = 0.0;
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const BentResidual r = bent_residual(problem_, c, i, out[i] / problem_.weight[i]);
    out[i] = r.residual;
    state.slope[i] = r.slope / problem_.weight[i];
    loss += r.loss;
    slopes += r.kernel.slope;
    curvatures += r.kernel.curvature;
  }
  state.kernel_share = slopes > 0.0 ? curvatures / slopes : 1.0;
  return loss;
}

void Model::slopes_and_deviations(std::size_t channel, const Eigen::VectorXd& residuals, Eigen::VectorXd& slopes,
                                  Eigen::VectorXd& deviations) const {
  const ProblemChannel& c = problem_.channels[channel];
  slopes = problem_.weight;
  emphasise(channel, slopes);
  if (problem_.quadratic()) {
    deviations = residuals.cwiseQuotient(slopes);
  } else {
    deviations = states_[channel].weighted.cwiseQuotient(problem_.weight) - c.value;
  }
  if (c.used.size() > 0) deviations = (c.used.array() > 0.0).select(deviations, 0.0);
}

void Model::by_shape(std::size_t channel, const SmallVector& k, int i, Eigen::Ref<Eigen::VectorXd> out) const {
  const Group& group = groups_[group_[channel]];
  out.setZero();
  for (Eigen::Index j = 0; j < group.products.cols(); ++j) {
    const double a = amplitude(j, k);
    if (a == 0.0 || !problem_.basis->columns()[static_cast<std::size_t>(j)].reads_shape) continue;
    for (Eigen::Index parameter = 0; parameter < parameters_; ++parameter) {
      const double chain = a * problem_.shape.map(parameter, i);
      if (chain != 0.0) {
        add_scaled(chain, group.shape_products.col(j * parameters_ + parameter).data(), out.data(), problem_.samples());
      }
    }
  }
  emphasise(channel, out);
}

void Model::by_coefficient(std::size_t channel, const SmallVector& k, std::size_t coefficient,
                           Eigen::Ref<Eigen::VectorXd> out) const {
  const Eigen::MatrixXd& products = groups_[group_[channel]].products;
  out.setZero();
  for (std::size_t j = 0; j < problem_.basis->columns().size(); ++j) {
    const BasisColumn& c = problem_.basis->columns()[j];
    if (c.coefficient != coefficient) continue;
    const double chain = c.power == 2 ? 2.0 * k[static_cast<Eigen::Index>(coefficient)] : 1.0;
    add_scaled(chain, products.col(static_cast<Eigen::Index>(j)).data(), out.data(), problem_.samples());
  }
  emphasise(channel, out);
}

void Model::by_optics(std::size_t channel, const SmallVector& k, Eigen::Ref<Eigen::VectorXd> out) const {
  const Group& group = groups_[group_[channel]];
  const Eigen::MatrixXd& shape = factors_[group.factors].values;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(shape.rows());
  for (Eigen::Index j = 0; j < shape.cols(); ++j) {
    sum.noalias() += amplitude(j, k) * group.optics_derivatives.col(j).cwiseProduct(shape.col(j));
  }
  problem_.sums.apply(sum);
  out = sum;
  emphasise(channel, out);
}

std::vector<const double*> Model::columns_of(const Group& group) const {
  std::vector<const double*> columns;
  for (Eigen::Index j = 0; j < group.products.cols(); ++j) columns.push_back(group.products.col(j).data());
  for (Eigen::Index j = 0; j < group.products.cols(); ++j) {
    if (!problem_.basis->columns()[static_cast<std::size_t>(j)].reads_shape) continue;
    for (Eigen::Index parameter = 0; parameter < parameters_; ++parameter)
      columns.push_back(group.shape_products.col(j * parameters_ + parameter).data());
  }
  return columns;
}

Eigen::MatrixXd Model::combinations(const SmallVector& k) const {
  const std::vector<BasisColumn>& columns = problem_.basis->columns();
  const auto shape_reading =
      std::count_if(columns.begin(), columns.end(), [](const BasisColumn& c) { return c.reads_shape; });
  const auto products = static_cast<Eigen::Index>(columns.size());
  const Eigen::Index free = problem_.shape.free;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(products + shape_reading * parameters_, free + k.size());
  Eigen::Index first = products;
  for (Eigen::Index j = 0; j < products; ++j) {
    const BasisColumn& c = columns[static_cast<std::size_t>(j)];
    const auto coefficient = static_cast<Eigen::Index>(c.coefficient);
    out(j, free + coefficient) = c.power == 2 ? 2.0 * k[coefficient] : 1.0;
    if (!c.reads_shape) continue;
    out.block(first, 0, parameters_, free) = amplitude(j, k) * problem_.shape.map;
    first += parameters_;
  }
  return out;
}

// Of channels without an emphasis of their own the products of columns are the group's; their own are those with the
// residuals. These row by row: the difference of products would lose them where they are small.
ChannelEquations Model::shared_equations(std::size_t channel, const SmallVector& k) {
  Group& group = groups_[group_[channel]];
  std::vector<const double*> columns = columns_of(group);
  const std::size_t count = columns.size();
  if (group.squares.empty()) {
    group.squares.assign(count * (count + 1) / 2, 0.0);
    add_products(columns.data(), count, problem_.samples(), group.squares.data());
  }
  ChannelEquations out;
  out.loss = residuals(channel, k, scratch_);
  Eigen::VectorXd with = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  add_products_with(columns.data(), count, scratch_.data(), problem_.samples(), with.data());
  Eigen::MatrixXd squares(with.size(), with.size());
  const double* from = group.squares.data();
  for (Eigen::Index b = 0; b < squares.cols(); ++b) {
    for (Eigen::Index a = 0; a <= b; ++a) squares(a, b) = squares(b, a) = *from++;
  }
  const Eigen::MatrixXd by = combinations(k);
  const Eigen::Index width = by.cols();
  out.products.resize(width + 1, width + 1);
  out.products.topLeftCorner(width, width).noalias() = by.transpose() * (squares * by);
  out.products.col(width).head(width).noalias() = by.transpose() * with;
  out.products.row(width).head(width) = out.products.col(width).head(width).transpose();
  out.products(width, width) = out.loss;
  return out;
}

ChannelEquations Model::equations(std::size_t channel, const SmallVector& k) {
  const bool fixed = problem_.free_optics == FreeOptics::none;
  if (fixed && problem_.quadratic() && problem_.channels[channel].emphasis.size() == 0)
    return shared_equations(channel, k);
  ChannelEquations out;
  const auto n = static_cast<Eigen::Index>(problem_.samples());
  const Eigen::Index free = problem_.shape.free;
  const Eigen::Index width = free + k.size() + (fixed ? 0 : 1);
  Eigen::VectorXd r;
  out.loss = residuals(channel, k, r);
  Eigen::MatrixXd all(n, width + 1);
  for (Eigen::Index z = 0; z < free; ++z) by_shape(channel, k, static_cast<int>(z), all.col(z));
  for (Eigen::Index j = 0; j < k.size(); ++j)
    by_coefficient(channel, k, static_cast<std::size_t>(j), all.col(free + j));
  if (!fixed) by_optics(channel, k, all.col(width - 1));
  all.col(width) = r;
  std::vector<const double*> columns;
  for (Eigen::Index j = 0; j <= width; ++j) columns.push_back(all.col(j).data());
  std::vector<double> packed(columns.size() * (columns.size() + 1) / 2, 0.0);
  add_products(columns.data(), columns.size(), problem_.samples(), packed.data());
  out.products.resize(width + 1, width + 1);
  const double* from = packed.data();
  for (Eigen::Index b = 0; b <= width; ++b) {
    for (Eigen::Index a = 0; a <= b; ++a) out.products(a, b) = out.products(b, a) = *from++;
  }
  return out;
}

Linearisation linearise(const Problem& problem, const FitPoint& point) {
  Model model(problem);
  return linearise(problem, model, point);
}

Linearisation linearise(const Problem& problem, Model& model, const FitPoint& point) {
  model.set_shape(point.z.data(), true);
  Linearisation l;
  double share = 0.0;
  const auto n = static_cast<Eigen::Index>(problem.samples());
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const SmallVector& k = point.coefficients[c];
    if (!point.optics.empty()) model.set_optics(c, point.optics[c]);
    l.loss += model.residuals(c, k, l.residuals.emplace_back());
    model.slopes_and_deviations(c, l.residuals.back(), l.slopes.emplace_back(), l.deviations.emplace_back());
    share += model.kernel_share(c) / static_cast<double>(problem.channels.size());
    Eigen::MatrixXd& shape = l.by_shape.emplace_back(n, problem.shape.free);
    for (int z = 0; z < problem.shape.free; ++z) model.by_shape(c, k, z, shape.col(z));
    Eigen::MatrixXd& coefficients = l.by_coefficient.emplace_back(n, k.size());
    for (Eigen::Index j = 0; j < k.size(); ++j) {
      model.by_coefficient(c, k, static_cast<std::size_t>(j), coefficients.col(j));
    }
    Eigen::VectorXd& by_optics = l.by_optics.emplace_back();
    if (point.optics.empty()) continue;
    by_optics.resize(n);
    model.by_optics(c, k, by_optics);
  }
  l.kernel_share = share;
  return l;
}

}  // namespace goniofit
