#include "fit/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/dot.h"

namespace goniofit {

namespace {

std::vector<double*> column_pointers(Eigen::MatrixXd& m) {
  std::vector<double*> pointers;
  for (Eigen::Index j = 0; j < m.cols(); ++j) pointers.push_back(m.col(j).data());
  return pointers;
}

// Values of a free optical parameter that the search tries; the polish finishes. F0 changes fastest near 0 (n near 1).
std::vector<double> optics_grid(FreeOptics which, double lower, double upper) {
  constexpr int points = 24;
  std::vector<double> grid;
  for (int i = 0; i < points; ++i) {
    const double t = (i + 0.5) / points;
    if (which == FreeOptics::f0) {
      grid.push_back(lower + (upper - lower) * t * t);
    } else {
      grid.push_back(lower * std::pow(upper / lower, t * t));
    }
  }
  return grid;
}

void select_rows(const Eigen::VectorXd& from, const std::vector<std::size_t>& rows, Eigen::VectorXd& to) {
  to.resize(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    to[static_cast<Eigen::Index>(i)] = from[static_cast<Eigen::Index>(rows[i])];
  }
}

// gram and rhs += those of the columns of `a` against the targets.
void accumulate(const Eigen::MatrixXd& a, const Eigen::VectorXd& target, SmallMatrix* gram,
                Eigen::Ref<Eigen::VectorXd> rhs) {
  const auto n = static_cast<std::size_t>(a.rows());
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    rhs[j] += dot(a.col(j).data(), target.data(), n);
    if (gram == nullptr) continue;
    for (Eigen::Index k = 0; k <= j; ++k) {
      const double g = dot(a.col(j).data(), a.col(k).data(), n);
      (*gram)(j, k) += g;
      if (j != k) (*gram)(k, j) += g;
    }
  }
}

}  // namespace

Profile::Profile(const Problem& problem)
    : problem_(problem), columns_(problem.basis->columns().size()), solver_(*problem.basis) {
  std::vector<std::size_t> early;
  std::vector<std::size_t> late;
  for (std::size_t i = 0; i < problem.samples(); ++i) {
    (problem.basis->reads_length(problem.pairs[i]) ? late : early).push_back(i);
  }
  early_ = problem.pairs.subset(early);
  late_ = problem.pairs.subset(late);
  select_rows(problem.weight, early, early_weight_);
  select_rows(problem.weight, late, late_weight_);
  for (const ProblemChannel& c : problem.channels) {
    select_rows(c.target, early, early_target_.emplace_back());
    select_rows(c.target, late, late_target_.emplace_back());
    target2_.push_back(c.target.squaredNorm());
  }
  for (std::size_t g = 0; g < problem.optics_groups; ++g) add_group(g);
  early_shape_.resize(early_weight_.size(), static_cast<Eigen::Index>(columns_));
  product_.resize(early_weight_.size(), static_cast<Eigen::Index>(columns_));
}

Eigen::MatrixXd Profile::weighted_optics(const ChannelOptics& optics, const PairBatch& pairs,
                                         const Eigen::VectorXd& weight) const {
  Eigen::MatrixXd result(weight.size(), static_cast<Eigen::Index>(columns_));
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    const Pair p = pairs[static_cast<std::size_t>(i)];
    const double f = fresnel(problem_.terms.fresnel, optics, p);
    const double t = transmission(problem_.terms.fresnel, optics, p);
    for (std::size_t j = 0; j < columns_; ++j) {
      const OpticsFactor factor = problem_.basis->columns()[j].optics;
      double o = 1.0;
      if (factor == OpticsFactor::fresnel) o = f;
      if (factor == OpticsFactor::transmission) o = t;
      if (factor == OpticsFactor::remainder) o = remainder(problem_.terms.fresnel, optics, p);
      result(i, static_cast<Eigen::Index>(j)) = weight[i] * o;
    }
  }
  return result;
}

void Profile::add_group(std::size_t index) {
  Group group;
  for (std::size_t c = 0; c < problem_.channels.size(); ++c) {
    if (problem_.channels[c].optics_group == index) group.channels.push_back(c);
  }
  const ProblemChannel& first = problem_.channels[group.channels.front()];
  const bool fixed = problem_.free_optics == FreeOptics::none;
  const std::vector<double> values =
      fixed ? std::vector<double>{0.0} : optics_grid(problem_.free_optics, first.optics_lower, first.optics_upper);
  for (const double value : values) {
    const ChannelOptics optics = fixed ? first.optics : problem_.optics_at(group.channels.front(), value);
    Candidate candidate;
    candidate.value = value;
    candidate.early = weighted_optics(optics, early_, early_weight_);
    candidate.late = weighted_optics(optics, late_, late_weight_);
    group.candidates.push_back(std::move(candidate));
  }
  groups_.push_back(std::move(group));
}

void Profile::update_early(const Eigen::VectorXd& shape) {
  const Eigen::Index read = shape.size() - (problem_.basis->has_length() ? 1 : 0);
  if (early_at_.size() == read + 1 && early_at_.head(read) == shape.head(read)) return;
  early_at_.resize(read + 1);  // one more, so that an empty one is none yet
  early_at_.head(read) = shape.head(read);
  if (early_weight_.size() == 0) return reset_early_equations();
  const std::vector<double*> pointers = column_pointers(early_shape_);
  problem_.basis->shape_factors(early_, std::span(shape.data(), static_cast<std::size_t>(shape.size())), 1.0, pointers);
  const auto n = static_cast<std::size_t>(early_weight_.size());
  const auto columns = static_cast<Eigen::Index>(columns_);
  for (Group& group : groups_) {
    for (Candidate& candidate : group.candidates) {
      for (Eigen::Index j = 0; j < columns; ++j) {
        multiply(candidate.early.col(j).data(), early_shape_.col(j).data(), product_.col(j).data(), n);
      }
      candidate.gram = SmallMatrix::Zero(columns, columns);
      candidate.rhs = Eigen::MatrixXd::Zero(columns, static_cast<Eigen::Index>(group.channels.size()));
      for (std::size_t k = 0; k < group.channels.size(); ++k) {
        accumulate(product_, early_target_[group.channels[k]], k == 0 ? &candidate.gram : nullptr,
                   candidate.rhs.col(static_cast<Eigen::Index>(k)));
      }
    }
  }
}

void Profile::reset_early_equations() {
  const auto columns = static_cast<Eigen::Index>(columns_);
  for (Group& group : groups_) {
    for (Candidate& candidate : group.candidates) {
      candidate.gram = SmallMatrix::Zero(columns, columns);
      candidate.rhs = Eigen::MatrixXd::Zero(columns, static_cast<Eigen::Index>(group.channels.size()));
    }
  }
}

Profile::Choice Profile::choose_from(std::size_t channel, const Group& group, std::size_t position,
                                     const Eigen::MatrixXd& late_shape) const {
  const ProblemChannel& c = problem_.channels[channel];
  Choice best;
  best.loss = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : group.candidates) {
    SmallMatrix gram = candidate.gram;
    Eigen::VectorXd rhs = candidate.rhs.col(static_cast<Eigen::Index>(position));
    if (late_shape.rows() > 0) {
      const Eigen::MatrixXd product = candidate.late.cwiseProduct(late_shape);
      accumulate(product, late_target_[channel], &gram, rhs);
    }
    const CoefficientSolver::Solution solution = solver_.solve(gram, rhs, c.lower, c.upper);
    // The difference of near equals: round-off may leave it a little below zero on noise-free data.
    const double sum = target2_[channel] + solution.value;
    if (!std::isfinite(sum)) continue;  // a shape factor left the range of doubles
    const double loss = std::max(0.0, sum);
    if (loss < best.loss) best = {solution, loss, candidate.value};
  }
  return best;
}

FitPoint Profile::point(const double* z) {
  ++evaluations_;
  const Eigen::VectorXd shape = problem_.shape.at(z);
  update_early(shape);
  FitPoint p;
  p.z.assign(z, z + problem_.shape.free);
  p.coefficients.resize(problem_.channels.size());
  if (problem_.free_optics != FreeOptics::none) p.optics.resize(problem_.channels.size());
  Eigen::MatrixXd late_shape(late_weight_.size(), static_cast<Eigen::Index>(columns_));
  for (const Group& group : groups_) {
    for (std::size_t k = 0; k < group.channels.size(); ++k) {
      const std::size_t channel = group.channels[k];
      if (late_weight_.size() > 0) {
        problem_.basis->shape_factors(late_, std::span(shape.data(), static_cast<std::size_t>(shape.size())),
                                      problem_.wavelength(channel), column_pointers(late_shape));
      }
      const Choice choice = choose_from(channel, group, k, late_shape);
      p.loss += choice.loss;
      p.coefficients[channel] = choice.solution.k;
      if (!p.optics.empty()) p.optics[channel] = choice.optics;
    }
  }
  return p;
}

double Profile::loss(const double* z) { return point(z).loss; }

}  // namespace goniofit
