#pragma once
// Logistic regression: P = 1 / (1 + exp(-(b_0 + sum b_k x_k))) fitted by maximum likelihood.
//   Newton's method: H = X^T W X, W = p (1 - p), b += H^-1 X^T (y - p); standard errors are the
//   roots of diag(H^-1).
#include <vector>

namespace fabrica {

struct LogisticFit {
  std::vector<double> coefficients, standard_errors;  // b_0, b_1, ...
  double log_likelihood = 0;
  double probability(const std::vector<double>& x) const;
};

// rows[i] holds the x of observation i, happened[i] its outcome. Throws SignalError
// "ragged-signal", "one-outcome" if all outcomes are equal, "separable" if the likelihood has no
// maximum.
LogisticFit fit_logistic(const std::vector<std::vector<double>>& rows,
                         const std::vector<bool>& happened);

}  // namespace fabrica
