#pragma once
// Logistic regression of a table of outcomes, by maximum likelihood:
//   logit P(outcome >= level) = b0 + sum_k b_k x_k
// Newton's method on the log-likelihood (iteratively reweighted least squares; D. R. Cox, 1958).
#include <string>
#include <utility>
#include <vector>

#include "study/case_file.h"

namespace fabrica::study {

// Coefficients and their standard errors, intercept first: rows of `x` are tests (without the
// column of ones), `event` is 0 or 1. Throws StudyError if all or none are events, or if the two
// kinds are separated by a plane, so that no finite maximum exists.
struct LogisticFit {
  std::vector<double> coefficient, standard_error;
  int iterations = 0;
};
LogisticFit fit_logistic(const std::vector<std::vector<double>>& x, const std::vector<int>& event);

// The numbers of a fit of a case: "intercept" and one per predictor, "<name> standard error",
// "tests", "events".
std::vector<std::pair<std::string, double>> fit_outcomes(const FitSpec& fit, const Case& c);

}  // namespace fabrica::study
