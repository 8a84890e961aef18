#include "fit/linear_parts.h"

#include "fit/triangle.h"

namespace goniofit {

namespace {

std::vector<const double*> columns_of(const Linearisation& l, std::size_t c) {
  std::vector<const double*> columns;
  for (Eigen::Index z = 0; z < l.by_shape[c].cols(); ++z) columns.push_back(l.by_shape[c].col(z).data());
  for (Eigen::Index j = 0; j < l.by_coefficient[c].cols(); ++j) columns.push_back(l.by_coefficient[c].col(j).data());
  if (l.by_optics[c].size() > 0) columns.push_back(l.by_optics[c].data());
  columns.push_back(l.residuals[c].data());
  return columns;
}

void add(const Problem& part, const Linearisation& l, std::size_t c, LinearSums::Differences& to) {
  const Eigen::VectorXd& used = part.channels[c].used;
  for (std::size_t i = 0; i < part.readings(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (used.size() > 0 && used[at] == 0.0) continue;
    const double square = l.deviations[c][at] * l.deviations[c][at];
    to.values += 1.0;
    to.squares += square;
    to.cosine_squares += part.pairs.cos_i[i] * square;
  }
}

}  // namespace

void LinearParts::for_each(const Visit& visit) const {
  if (!problem_.by_parts()) return visit(problem_, whole_);
  problem_.for_each_part([&](const Problem& part) { visit(part, linearise(part, point_)); });
}

void LinearParts::visit_drawn(const VisitSome& visit) const {
  if (!problem_.by_parts()) return visit(problem_, whole_, {});
  const Problem drawn = problem_.part(problem_.drawn.rows);
  visit(drawn, linearise(drawn, point_), problem_.drawn.factor);
}

NoiseModel noise_model(const LinearParts& parts) {
  const Problem& problem = parts.problem();
  NoiseModel out;
  if (!problem.by_parts()) {
    parts.for_each([&](const Problem& whole, const Linearisation& l) { out = noise_model(problem, whole, l); });
    return out;
  }
  const Problem some = problem.part(rows_that_tell_noise(problem));
  return noise_model(problem, some, linearise(some, parts.point()));
}

LinearSums linear_sums(const LinearParts& parts, const NoiseModel* noise) {
  LinearSums out;
  const std::size_t channels = parts.problem().channels.size();
  out.triangles.resize(channels);
  out.differences.resize(channels);
  if (noise != nullptr) out.whitened.resize(channels);
  parts.for_each([&](const Problem& part, const Linearisation& l) {
    out.loss += l.loss;
    for (std::size_t c = 0; c < channels; ++c) {
      const std::vector<const double*> columns = columns_of(l, c);
      add_to_triangle(columns, l.residuals[c].size(), nullptr, out.triangles[c]);
      add(part, l, c, out.differences[c]);
      if (noise == nullptr) continue;
      const Eigen::VectorXd whitener = noise_of_rows(part, l, *noise, c).whitener;
      add_to_triangle(columns, l.residuals[c].size(), whitener.data(), out.whitened[c]);
    }
  });
  return out;
}

}  // namespace goniofit
