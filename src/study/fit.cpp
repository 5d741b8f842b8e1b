#include "study/fit.h"

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "body/tables.h"
#include "study/error.h"
#include "study/outcome.h"

namespace fabrica::study {
namespace {

constexpr int most_iterations = 100;

// "column >= number"
struct Requirement {
  std::string column;
  double at_least = 0;
};
Requirement parse(const std::string& text, const FitSpec& f, const Case& c) {
  const std::size_t at = text.find(" >= ");
  char* end = nullptr;
  const double value = at == std::string::npos ? 0 : std::strtod(text.c_str() + at + 4, &end);
  if (at == std::string::npos || *end != '\0')
    throw StudyError(c.file, f.line, "fit.require", "'" + text + "' is not understood",
                     "Write \"column >= number\"");
  return {text.substr(0, at), value};
}

}  // namespace

LogisticFit fit_logistic(const std::vector<std::vector<double>>& x, const std::vector<int>& event) {
  const Eigen::Index n = Eigen::Index(x.size()), k = x.empty() ? 1 : Eigen::Index(x[0].size()) + 1;
  Eigen::MatrixXd design(n, k);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    design(i, 0) = 1;
    for (Eigen::Index j = 1; j < k; ++j) design(i, j) = x[std::size_t(i)][std::size_t(j - 1)];
    y(i) = event[std::size_t(i)];
  }
  if (n == 0 || y.sum() == 0 || y.sum() == double(n))
    throw StudyError("a logistic fit needs tests with and without the event. Change the level");
  Eigen::VectorXd b = Eigen::VectorXd::Zero(k);
  LogisticFit fit;
  Eigen::MatrixXd information(k, k);
  for (; fit.iterations < most_iterations; ++fit.iterations) {
    const Eigen::VectorXd p = (1 / (1 + (-(design * b)).array().exp())).matrix();
    information = design.transpose() * (p.array() * (1 - p.array())).matrix().asDiagonal() * design;
    const Eigen::VectorXd step = information.ldlt().solve(design.transpose() * (y - p));
    b += step;
    if (!step.allFinite() || b.cwiseAbs().maxCoeff() > 1e6) break;
    if (step.norm() <= 1e-12 * (1 + b.norm())) {
      const Eigen::MatrixXd covariance = information.inverse();
      for (Eigen::Index j = 0; j < k; ++j) {
        fit.coefficient.push_back(b(j));
        fit.standard_error.push_back(std::sqrt(covariance(j, j)));
      }
      return fit;
    }
  }
  throw StudyError(
      "the logistic fit has no finite maximum: the predictors separate the outcomes. " +
      std::string("Take fewer predictors or another level"));
}

std::vector<std::pair<std::string, double>> fit_outcomes(const FitSpec& f, const Case& c) {
  const std::string path = (std::filesystem::path(c.folder) / f.data).string();
  const std::string text = read_file(path);
  if (text.empty())
    throw StudyError(c.file, f.line, "fit.data", "there is no " + path, "Add the file");
  const body::Table table(path, text);
  std::vector<Requirement> requirements;
  for (const std::string& r : f.require) requirements.push_back(parse(r, f, c));
  std::vector<std::vector<double>> x;
  std::vector<int> event;
  for (int row = 0; row < table.rows(); ++row) {
    bool kept = true;
    for (const Requirement& r : requirements)
      kept = kept && table.number(row, r.column) >= r.at_least;
    if (!kept) continue;
    x.emplace_back();
    for (const std::string& p : f.predictors) x.back().push_back(table.number(row, p));
    event.push_back(table.number(row, f.outcome) >= f.at_least);
  }
  const LogisticFit fit = fit_logistic(x, event);
  std::vector<std::pair<std::string, double>> out;
  int events = 0;
  for (const int e : event) events += e;
  out.emplace_back("tests", double(x.size()));
  out.emplace_back("events", double(events));
  for (std::size_t j = 0; j < fit.coefficient.size(); ++j) {
    const std::string name = j == 0 ? "intercept" : f.predictors[j - 1];
    out.emplace_back(name, fit.coefficient[j]);
    out.emplace_back(name + " standard error", fit.standard_error[j]);
  }
  return out;
}

}  // namespace fabrica::study
