#include "injury/logistic.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "signal/curve.h"

namespace fabrica {
namespace {

constexpr int most_steps = 50;
constexpr double converged = 1e-10, endless = 1e3;  // of the coefficients of standardised x

// x of each column less its mean, over its standard deviation: the Newton step is then well
// conditioned
struct Standard {
  Eigen::VectorXd mean, deviation;
};

Eigen::MatrixXd design(const std::vector<std::vector<double>>& rows, Standard& s) {
  const long n = long(rows.size()), m = long(rows[0].size());
  Eigen::MatrixXd x(n, m + 1);
  for (long i = 0; i < n; ++i) {
    if (long(rows[i].size()) != m)
      throw SignalError("ragged-signal", "observations differ in their number of variables",
                        "Complete them");
    x(i, 0) = 1;
    for (long k = 0; k < m; ++k) x(i, k + 1) = rows[i][k];
  }
  s.mean = Eigen::VectorXd::Zero(m + 1), s.deviation = Eigen::VectorXd::Ones(m + 1);
  for (long k = 1; k <= m; ++k) {
    s.mean[k] = x.col(k).mean();
    s.deviation[k] = std::sqrt((x.col(k).array() - s.mean[k]).square().mean());
    if (!(s.deviation[k] > 0))
      throw SignalError("flat-reference", "a variable never changes", "Leave it out");
    x.col(k) = (x.col(k).array() - s.mean[k]) / s.deviation[k];
  }
  return x;
}

}  // namespace

double LogisticFit::probability(const std::vector<double>& x) const {
  double sum = coefficients[0];
  for (std::size_t k = 0; k < x.size(); ++k) sum += coefficients[k + 1] * x[k];
  return 1 / (1 + std::exp(-sum));
}

LogisticFit fit_logistic(const std::vector<std::vector<double>>& rows,
                         const std::vector<bool>& happened) {
  if (rows.empty() || rows.size() != happened.size())
    throw SignalError("ragged-signal", "observations and outcomes differ in number",
                      "Give one outcome for each");
  const long events = std::count(happened.begin(), happened.end(), true);
  if (events == 0 || events == long(happened.size()))
    throw SignalError("one-outcome", "all outcomes are the same", "A risk needs both");
  Standard s;
  const Eigen::MatrixXd x = design(rows, s);
  Eigen::VectorXd y(x.rows()), b = Eigen::VectorXd::Zero(x.cols()), p, change;
  for (long i = 0; i < y.size(); ++i) y[i] = happened[i];
  Eigen::MatrixXd hessian;
  for (int step = 0;; ++step) {
    p = (1 + (-(x * b)).array().exp()).inverse();
    hessian = x.transpose() * (p.array() * (1 - p.array())).matrix().asDiagonal() * x;
    change = hessian.ldlt().solve(x.transpose() * (y - p));
    b += change;
    if (change.cwiseAbs().maxCoeff() < converged) break;
    if (step == most_steps || !(b.cwiseAbs().maxCoeff() < endless))
      throw SignalError(
          "separable", "the outcomes are separated by the variables: the likelihood has no maximum",
          "Take fewer variables or more observations");
  }
  // back from standardised variables: b = T b', T linear
  const long m = x.cols();
  Eigen::MatrixXd back = Eigen::MatrixXd::Identity(m, m);
  for (long k = 1; k < m; ++k)
    back(k, k) = 1 / s.deviation[k], back(0, k) = -s.mean[k] / s.deviation[k];
  const Eigen::VectorXd natural = back * b;
  const Eigen::MatrixXd covariance = back * hessian.inverse() * back.transpose();
  LogisticFit fit;
  for (long k = 0; k < m; ++k) {
    fit.coefficients.push_back(natural[k]);
    fit.standard_errors.push_back(std::sqrt(covariance(k, k)));
  }
  p = (1 + (-(x * b)).array().exp()).inverse();
  for (long i = 0; i < y.size(); ++i) fit.log_likelihood += std::log(happened[i] ? p[i] : 1 - p[i]);
  return fit;
}

}  // namespace fabrica
