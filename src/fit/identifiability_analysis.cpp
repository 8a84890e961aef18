#include "fit/identifiability_analysis.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fit/triangle.h"

namespace goniofit {

namespace {

constexpr double weak_below = 1.0;
constexpr double null_below = 1e-9;  // of the largest singular value
constexpr double belongs = 0.15;     // entry of the projector
constexpr double part_of_range = 0.1;
constexpr double most_of_unbounded = 10.0;
constexpr double least_f0 = 0.04;

bool near(double value, double bound) {
  return std::isfinite(bound) && std::fabs(value - bound) <= 1e-12 * (1.0 + std::fabs(bound));
}

double coefficient_size(double value, double lower, double upper) {
  if (std::isfinite(upper - lower)) return std::max(std::fabs(value), part_of_range * (upper - lower));
  return std::clamp(std::fabs(value), part_of_range, most_of_unbounded);
}

class Analysis {
 public:
  Analysis(std::vector<DesignColumn> columns, const Eigen::MatrixXd& triangle);
  [[nodiscard]] Identifiability result() const;

 private:
  [[nodiscard]] std::vector<std::vector<Eigen::Index>> groups() const;
  [[nodiscard]] OpenDirection direction(const std::vector<Eigen::Index>& members) const;
  [[nodiscard]] std::optional<KnownCombination> combination(const std::vector<Eigen::Index>& pair) const;
  [[nodiscard]] std::optional<KnownCombination> sum_of(const DesignColumn& a, const DesignColumn& b,
                                                       const Eigen::Vector2d& t, double u) const;
  [[nodiscard]] std::optional<KnownCombination> product_of(const DesignColumn& a, const DesignColumn& b,
                                                           const Eigen::Vector2d& t, double u) const;

  std::vector<DesignColumn> columns_;
  Eigen::VectorXd singular_;
  Eigen::MatrixXd v_;
  Eigen::Index strong_ = 0;    // as many singular values are at least weak_below
  Eigen::MatrixXd projector_;  // on the directions of the others
};

Analysis::Analysis(std::vector<DesignColumn> columns, const Eigen::MatrixXd& triangle)
    : columns_(std::move(columns)), singular_(Eigen::VectorXd::Zero(triangle.cols())) {
  // A matrix of fewer rows has as many more null directions: rows of zeros bring them in.
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(triangle.cols(), triangle.cols());
  square.topRows(triangle.rows()) = triangle;
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(square, Eigen::ComputeFullV);
  singular_ = svd.singularValues();
  v_ = svd.matrixV();
  while (strong_ < singular_.size() && singular_[strong_] >= weak_below) ++strong_;
  const Eigen::MatrixXd open = v_.rightCols(v_.cols() - strong_);
  projector_ = open * open.transpose();
}

// Connected parts of the graph that the projector's entries draw.
std::vector<std::vector<Eigen::Index>> Analysis::groups() const {
  std::vector<std::vector<Eigen::Index>> out;
  std::vector<bool> seen(columns_.size(), false);
  for (Eigen::Index first = 0; first < projector_.rows(); ++first) {
    if (seen[static_cast<std::size_t>(first)] || projector_(first, first) <= belongs) continue;
    std::vector<Eigen::Index> members{first};
    seen[static_cast<std::size_t>(first)] = true;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (Eigen::Index j = 0; j < projector_.rows(); ++j) {
        if (seen[static_cast<std::size_t>(j)] || std::fabs(projector_(members[i], j)) <= belongs) continue;
        seen[static_cast<std::size_t>(j)] = true;
        members.push_back(j);
      }
    }
    std::sort(members.begin(), members.end());
    out.push_back(std::move(members));
  }
  return out;
}

std::optional<KnownCombination> Analysis::sum_of(const DesignColumn& a, const DesignColumn& b, const Eigen::Vector2d& t,
                                                 double u) const {
  // Per unit of the parameters, the larger factor 1.
  const Eigen::Vector2d per_unit(t[0] / a.size, t[1] / b.size);
  const Eigen::Index lead = std::fabs(per_unit[0]) >= std::fabs(per_unit[1]) ? 0 : 1;
  const DesignColumn& first = lead == 0 ? a : b;
  const DesignColumn& second = lead == 0 ? b : a;
  const double factor = per_unit[1 - lead] / per_unit[lead];
  if (std::fabs(factor) < 0.05) return std::nullopt;
  KnownCombination out;
  out.sum = std::fabs(factor - 1.0) < 0.02;
  out.value = first.value + factor * second.value;
  out.u = u / std::fabs(per_unit[lead]);
  const std::string scaled = std::fabs(std::fabs(factor) - 1.0) < 0.02
                                 ? second.name
                                 : fmt::format("{:.2g} {}", std::fabs(factor), second.name);
  out.text = fmt::format("{} {} {}", first.name, factor > 0.0 ? "+" : "-", scaled);
  return out;
}

// In logarithms: k slope^p, with p a multiple of 1/2.
std::optional<KnownCombination> Analysis::product_of(const DesignColumn& a, const DesignColumn& b,
                                                     const Eigen::Vector2d& t, double u) const {
  const Eigen::Index lead = a.logarithm ? 1 : 0;
  const DesignColumn& first = lead == 0 ? a : b;
  const DesignColumn& second = lead == 0 ? b : a;
  const double power = t[1 - lead] / t[lead];
  const double rounded = 0.5 * std::round(2.0 * power);
  const bool simple = rounded != 0.0 && std::fabs(rounded) <= 4.0 && std::fabs(power - rounded) < 0.1;
  if (!simple || !second.logarithm || (!first.logarithm && first.value < first.size)) return std::nullopt;
  KnownCombination out;
  const std::string exponent = std::fabs(rounded) == 1.0 ? "" : fmt::format("^{:g}", std::fabs(rounded));
  out.text = fmt::format("{} {} {}{}", first.name, rounded > 0.0 ? "*" : "/", second.name, exponent);
  out.value = (first.logarithm ? std::exp(first.value) : first.value) * std::exp(rounded * second.value);
  out.u = std::fabs(out.value) * u / std::fabs(t[lead]);
  return out;
}

// The combination of two parameters that is normal to the one direction they leave open, where it is better known than
// they are themselves.
std::optional<KnownCombination> Analysis::combination(const std::vector<Eigen::Index>& pair) const {
  const double rank = projector_(pair[0], pair[0]) + projector_(pair[1], pair[1]);
  if (rank > 1.3 || strong_ == 0) return std::nullopt;
  Eigen::Vector2d t(-projector_(pair[0], pair[1]), projector_(pair[0], pair[0]));
  t.normalize();
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(v_.rows());
  whole[pair[0]] = t[0];
  whole[pair[1]] = t[1];
  const Eigen::VectorXd strong = v_.leftCols(strong_).transpose() * whole;
  const double u = strong.cwiseQuotient(singular_.head(strong_)).norm();
  if (u > 0.3) return std::nullopt;
  const DesignColumn& a = columns_[static_cast<std::size_t>(pair[0])];
  const DesignColumn& b = columns_[static_cast<std::size_t>(pair[1])];
  return a.logarithm || b.logarithm ? product_of(a, b, t, u) : sum_of(a, b, t, u);
}

OpenDirection Analysis::direction(const std::vector<Eigen::Index>& members) const {
  OpenDirection out;
  bool one_channel = true;
  for (const Eigen::Index i : members) {
    const DesignColumn& c = columns_[static_cast<std::size_t>(i)];
    out.names.push_back(c.name);
    out.keys.push_back(c.key());
    if (c.channel.empty()) continue;
    one_channel = one_channel && (out.channel.empty() || out.channel == c.channel);
    out.channel = c.channel;
  }
  if (!one_channel) out.channel.clear();
  const double floor = null_below * std::max(singular_[0], 1.0);
  double null = 0.0;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(projector_.rows(), projector_.cols());
  for (Eigen::Index k = strong_; k < singular_.size(); ++k) {
    const double s = std::max(singular_[k], floor);
    covariance += v_.col(k) * v_.col(k).transpose() / (s * s);
    for (const Eigen::Index i : members) null += singular_[k] <= floor ? v_(i, k) * v_(i, k) : 0.0;
  }
  out.null = null > 0.5;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> own(covariance(members, members), Eigen::EigenvaluesOnly);
  out.u = out.null ? std::numeric_limits<double>::infinity() : std::sqrt(own.eigenvalues().maxCoeff());
  if (members.size() == 2) out.known = combination(members);
  return out;
}

Identifiability Analysis::result() const {
  Identifiability out;
  out.singular_values.assign(singular_.begin(), singular_.end());
  const double least = singular_[singular_.size() - 1];
  if (singular_[0] == 0.0) {
    out.condition = std::numeric_limits<double>::infinity();
    return out;
  }
  const bool null = least <= null_below * singular_[0];
  out.condition = null ? std::numeric_limits<double>::infinity() : singular_[0] / least;
  for (const std::vector<Eigen::Index>& members : groups()) out.open.push_back(direction(members));
  const Eigen::VectorXd floored = singular_.cwiseMax(null_below * singular_[0]);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double u = columns_[i].size * v_.row(row).transpose().cwiseQuotient(floored).norm();
    if (!columns_[i].logarithm) out.least_u[columns_[i].key()] = u;
  }
  return out;
}

}  // namespace

std::vector<DesignColumn> design_columns(const Problem& problem, const FitPoint& point) {
  std::vector<DesignColumn> out;
  const ShapeMap& shape = problem.shape;
  for (std::size_t z = 0; z < point.z.size(); ++z) {
    out.push_back({.name = problem.basis->shape_parameters()[static_cast<std::size_t>(shape.row[z])].name,
                   .channel = {},
                   .column = static_cast<Eigen::Index>(z),
                   .value = point.z[z],
                   .logarithm = true,
                   .on_bound = near(point.z[z], shape.lower[z]) || near(point.z[z], shape.upper[z])});
  }
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    const ProblemChannel& channel = problem.channels[c];
    const auto add = [&](const std::string& name, Eigen::Index column, double value, double size, double lower,
                         double upper) {
      if (lower >= upper) return;
      out.push_back({.name = name,
                     .channel = channel.name,
                     .channel_index = static_cast<std::ptrdiff_t>(c),
                     .column = shape.free + column,
                     .value = value,
                     .size = size,
                     .on_bound = near(value, lower) || near(value, upper)});
    };
    for (Eigen::Index j = 0; j < channel.lower.size(); ++j) {
      const double k = point.coefficients[c][j];
      add(problem.basis->coefficients()[static_cast<std::size_t>(j)].name, j, k,
          coefficient_size(k, channel.lower[j], channel.upper[j]), channel.lower[j], channel.upper[j]);
    }
    if (point.optics.empty()) continue;
    const double value = point.optics[c];
    const bool f0 = problem.free_optics == FreeOptics::f0;
    add(f0 ? "f0" : "n", channel.lower.size(), value, f0 ? std::max(value, least_f0) : std::max(value - 1.0, 0.1),
        channel.optics_lower, channel.optics_upper);
  }
  return out;
}

Eigen::MatrixXd design_triangle(const std::vector<DesignColumn>& columns, const std::vector<Eigen::MatrixXd>& whitened,
                                Eigen::Index shape_columns) {
  const auto size = static_cast<Eigen::Index>(columns.size());
  std::vector<Eigen::MatrixXd> triangles;
  Eigen::Index rows = 0;
  for (const Eigen::MatrixXd& w : whitened) rows += triangles.emplace_back(triangle_of(w)).rows();
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(rows, size);
  Eigen::Index row = 0;
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const DesignColumn& from = columns[static_cast<std::size_t>(j)];
      const bool own = from.column < shape_columns || from.channel_index == static_cast<std::ptrdiff_t>(c);
      if (own) stacked.block(row, j, triangles[c].rows(), 1) = from.size * triangles[c].col(from.column);
    }
    row += triangles[c].rows();
  }
  return triangle_of(stacked);
}

Identifiability identify(const Problem& problem, const FitPoint& point, const LinearSums& sums) {
  std::vector<DesignColumn> columns = design_columns(problem, point);
  if (columns.empty()) return {};
  const Eigen::MatrixXd triangle = design_triangle(columns, sums.whitened, problem.shape.free);
  return Analysis(std::move(columns), triangle).result();
}

}  // namespace goniofit
