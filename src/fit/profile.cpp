#include "fit/profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fit/coefficient_refine.h"
#include "fit/dot.h"
#include "fit/optics_columns.h"

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

// gram and rhs += those of the columns of `a` against the targets.
void accumulate(const Eigen::MatrixXd& a, const double* target, SmallMatrix* gram, Eigen::Ref<Eigen::VectorXd> rhs) {
  const auto n = static_cast<std::size_t>(a.rows());
  std::array<const double*, most_columns> columns{};
  const auto count = static_cast<std::size_t>(a.cols());
  for (std::size_t j = 0; j < count; ++j) columns[j] = a.col(static_cast<Eigen::Index>(j)).data();
  add_products_with(columns.data(), count, target, n, rhs.data());
  if (gram == nullptr) return;
  std::array<double, most_columns*(most_columns + 1) / 2> products{};
  add_products(columns.data(), count, n, products.data());
  const double* from = products.data();
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    for (Eigen::Index k = 0; k <= j; ++k, ++from) {
      (*gram)(j, k) += *from;
      if (j != k) (*gram)(k, j) += *from;
    }
  }
}

}  // namespace

Profile::Profile(const Problem& problem, RowSelection selection)
    : problem_(problem),
      columns_(problem.basis->columns().size()),
      solver_(*problem.basis),
      selection_(std::move(selection)),
      emphasised_(is_transformed(problem.loss)) {
  for (const ProblemChannel& c : problem.channels) emphasised_ = emphasised_ || c.emphasis.size() > 0;
  divide();
  for (std::size_t c = 0; c < problem.channels.size(); ++c) {
    target2_.push_back(early_.target[c].squaredNorm() + late_.target[c].squaredNorm());
  }
  for (std::size_t g = 0; g < problem.optics_groups; ++g) add_group(g);
  add_dark_equations();
}

void Profile::divide() {
  const bool all_late = !problem_.quadratic();
  std::size_t point = 0;
  std::size_t selected = 0;
  for (std::size_t row = 0; row < problem_.samples(); ++row) {
    const bool skipped = !selection_.all() && (selected == selection_.rows.size() || selection_.rows[selected] != row);
    if (!skipped) {
      // A sum of points is divided no further.
      const bool late = all_late || (problem_.basis->has_length() &&
                                     (row >= problem_.readings() || problem_.basis->reads_length(problem_.pairs[row])));
      take(row, point, selection_.all() ? 1.0 : selection_.factor[selected], late ? late_ : early_);
      ++selected;
    }
    point += problem_.sums.points(row);
  }
  sort_by_onset();
  cut_into_blocks();
  late_.pairs = problem_.pairs.subset(late_.points);
  for (Part* const part : {&early_, &late_}) {
    part->point_weight = problem_.point_weight(std::vector<Eigen::Index>(part->points.begin(), part->points.end()));
    for (std::size_t i = 0; i < part->rows.size() && part->rows[i] < problem_.readings(); ++i)
      part->point_weight[static_cast<Eigen::Index>(i)] *= part->factor[i];
    fill(*part);
  }
}

// A sum's points stay together, and last.
void Profile::sort_by_onset() {
  std::vector<std::size_t>& points = early_.points;
  if (!early_.sums.none()) return;
  struct Onset {
    double z;
    std::size_t row;
    double factor;
  };
  std::vector<Onset> onsets;
  onsets.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    onsets.push_back({problem_.basis->onset(problem_.pairs[points[i]]), points[i], early_.factor[i]});
  std::sort(onsets.begin(), onsets.end(),
            [](const Onset& a, const Onset& b) { return a.z < b.z || (a.z == b.z && a.row < b.row); });
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = early_.rows[i] = onsets[i].row;  // a point a row, counted alike
    early_.factor[i] = onsets[i].factor;
  }
}

void Profile::cut_into_blocks() {
  const std::vector<std::size_t>& points = early_.points;
  constexpr std::size_t most = 256;
  const std::size_t step = early_.sums.none() ? most : std::max<std::size_t>(points.size(), 1);
  for (std::size_t first = 0; first < points.size(); first += step) {
    const std::size_t end = std::min(points.size(), first + step);
    Block& block = blocks_.emplace_back();
    block.pairs = problem_.pairs.subset(
        {points.begin() + static_cast<std::ptrdiff_t>(first), points.begin() + static_cast<std::ptrdiff_t>(end)});
    block.first_point = block.first_row = static_cast<Eigen::Index>(first);
    block.rows = static_cast<Eigen::Index>(early_.sums.none() ? end - first : early_.rows.size());
    block.onset = early_.sums.none() ? problem_.basis->onset(block.pairs[0]) : -std::numeric_limits<double>::infinity();
  }
}

void Profile::take(std::size_t row, std::size_t first_point, double factor, Part& part) const {
  if (row < problem_.readings()) {
    part.sums = RowSums(part.rows.size() + 1);
  } else {
    part.sums.add(problem_.sums.points(row));
  }
  part.rows.push_back(row);
  part.factor.push_back(factor);
  for (std::size_t i = 0; i < problem_.sums.points(row); ++i) part.points.push_back(first_point + i);
}

// Targets, and what they and the columns are multiplied by. Of a loss that bends f these are tangents at the readings:
// a start, from which the coefficients are refined.
void Profile::fill(Part& part) const {
  for (const ProblemChannel& c : problem_.channels) {
    Eigen::VectorXd& target = part.target.emplace_back(static_cast<Eigen::Index>(part.rows.size()));
    Eigen::VectorXd& emphasis = part.emphasis.emplace_back();
    if (emphasised_) emphasis.resize(target.size());
    for (std::size_t i = 0; i < part.rows.size(); ++i) {
      const auto to = static_cast<Eigen::Index>(i);
      const auto from = static_cast<Eigen::Index>(part.rows[i]);
      target[to] = part.factor[i] * c.target[from];
      if (!emphasised_) continue;
      emphasis[to] = (c.emphasis.size() > 0 ? c.emphasis[from] : 1.0) * transformed(problem_.loss, c.value[from]).slope;
      target[to] *= emphasis[to];
    }
  }
}

// gram and rhs += those of one channel; `columns` by row.
void Profile::add_equations(const Part& part, std::size_t channel, Eigen::Index first_row,
                            const Eigen::MatrixXd& columns, SmallMatrix* gram, Eigen::Ref<Eigen::VectorXd> rhs) const {
  const double* const target = part.target[channel].data() + first_row;
  if (!emphasised_) return accumulate(columns, target, gram, rhs);
  Eigen::MatrixXd own(columns.rows(), columns.cols());
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    multiply(columns.col(j).data(), part.emphasis[channel].data() + first_row, own.col(j).data(),
             static_cast<std::size_t>(columns.rows()));
  }
  accumulate(own, target, gram, rhs);
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
    candidate.early = optics_columns(problem_, optics, early_.points, early_.point_weight);
    candidate.late = optics_columns(problem_, optics, late_.points, late_.point_weight);
    group.candidates.push_back(std::move(candidate));
  }
  groups_.push_back(std::move(group));
}

void Profile::update_early(const Eigen::VectorXd& shape) {
  const Eigen::Index read = shape.size() - (problem_.basis->has_length() ? 1 : 0);
  if (early_at_.size() == read + 1 && early_at_.head(read) == shape.head(read)) return;
  early_at_.resize(read + 1);  // one more, so that an empty one is none yet
  early_at_.head(read) = shape.head(read);
  reset_early_equations();
  // What lies in the dark is known without looking.
  const auto lit = std::partition_point(
      blocks_.begin(), blocks_.end(), [&](const Block& block) { return shape.size() == 0 || block.onset < shape[0]; });
  const std::span<const double> z(shape.data(), static_cast<std::size_t>(shape.size()));
  for (auto block = blocks_.begin(); block != lit; ++block) {
    early_shape_.resize(static_cast<Eigen::Index>(block->pairs.size()), static_cast<Eigen::Index>(columns_));
    problem_.basis->shape_factors(block->pairs, z, 1.0, column_pointers(early_shape_));
    for (Group& group : groups_) {
      for (Candidate& candidate : group.candidates) {
        add_block(*block, group, candidate, candidate.gram, candidate.rhs);
      }
    }
  }
  const auto dark = static_cast<std::size_t>(lit - blocks_.begin());
  for (Group& group : groups_) {
    for (Candidate& candidate : group.candidates) {
      for (std::size_t k = 0; k < candidate.gram.size(); ++k) candidate.gram[k] += candidate.dark_gram[dark][k];
      candidate.rhs += candidate.dark_rhs[dark];
    }
  }
}

// gram and rhs += those of the block at the shape factors in early_shape_.
void Profile::add_block(const Block& block, const Group& group, const Candidate& candidate,
                        std::vector<SmallMatrix>& gram, Eigen::MatrixXd& rhs) {
  product_.resize(early_shape_.rows(), early_shape_.cols());
  for (Eigen::Index j = 0; j < product_.cols(); ++j) {
    multiply(candidate.early.col(j).data() + block.first_point, early_shape_.col(j).data(), product_.col(j).data(),
             static_cast<std::size_t>(product_.rows()));
  }
  early_.sums.apply(product_);
  for (std::size_t k = 0; k < group.channels.size(); ++k) {
    add_equations(early_, group.channels[k], block.first_row, product_, k < gram.size() ? &gram[k] : nullptr,
                  rhs.col(static_cast<Eigen::Index>(k)));
  }
}

// Of the columns that do not read the shape, over each block and all that follow.
void Profile::add_dark_equations() {
  reset_early_equations();
  for (Group& group : groups_) {
    for (Candidate& candidate : group.candidates) {
      candidate.dark_gram.push_back(candidate.gram);
      candidate.dark_rhs.push_back(candidate.rhs);
    }
  }
  const std::vector<BasisColumn>& columns = problem_.basis->columns();
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) {
    // What these columns hold at any shape; nothing in the others.
    early_shape_.resize(static_cast<Eigen::Index>(block->pairs.size()), static_cast<Eigen::Index>(columns_));
    const std::vector<double> anywhere(problem_.basis->shape_parameters().size(), 0.0);
    problem_.basis->shape_factors(block->pairs, anywhere, 1.0, column_pointers(early_shape_));
    for (std::size_t j = 0; j < columns_; ++j) {
      if (columns[j].reads_shape) early_shape_.col(static_cast<Eigen::Index>(j)).setZero();
    }
    for (Group& group : groups_) {
      for (Candidate& candidate : group.candidates) {
        std::vector<SmallMatrix> gram = candidate.dark_gram.back();
        Eigen::MatrixXd rhs = candidate.dark_rhs.back();
        add_block(*block, group, candidate, gram, rhs);
        candidate.dark_gram.push_back(std::move(gram));
        candidate.dark_rhs.push_back(std::move(rhs));
      }
    }
  }
  for (Group& group : groups_) {
    for (Candidate& candidate : group.candidates) {
      std::reverse(candidate.dark_gram.begin(), candidate.dark_gram.end());
      std::reverse(candidate.dark_rhs.begin(), candidate.dark_rhs.end());
    }
  }
}

void Profile::reset_early_equations() {
  const auto columns = static_cast<Eigen::Index>(columns_);
  for (Group& group : groups_) {
    for (Candidate& candidate : group.candidates) {
      candidate.gram.assign(emphasised_ ? group.channels.size() : 1, SmallMatrix::Zero(columns, columns));
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
    SmallMatrix gram = candidate.gram[emphasised_ ? position : 0];
    Eigen::VectorXd rhs = candidate.rhs.col(static_cast<Eigen::Index>(position));
    Eigen::MatrixXd product;
    if (late_shape.rows() > 0) {
      product = candidate.late.cwiseProduct(late_shape);
      late_.sums.apply(product);
      add_equations(late_, channel, 0, product, &gram, rhs);
    }
    CoefficientSolver::Solution solution = solver_.solve(gram, rhs, c.lower, c.upper);
    if (!problem_.quadratic()) {
      solution = refine_coefficients(problem_, channel, solver_, product, solution.k);
      solution.value -= target2_[channel];
    }
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
  Eigen::MatrixXd late_shape(late_.point_weight.size(), static_cast<Eigen::Index>(columns_));
  bool have_late = false;
  for (const Group& group : groups_) {
    for (std::size_t k = 0; k < group.channels.size(); ++k) {
      const std::size_t channel = group.channels[k];
      if (!late_.rows.empty() && !(have_late && !problem_.basis->has_length())) {
        problem_.basis->shape_factors(late_.pairs, std::span(shape.data(), static_cast<std::size_t>(shape.size())),
                                      problem_.wavelength(channel), column_pointers(late_shape));
        have_late = true;
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
