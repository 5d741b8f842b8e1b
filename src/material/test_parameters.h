#pragma once
// Parameters from a list of values, for the tests of laws. Owns its curves.
#include <array>
#include <deque>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/parameters.h"

namespace fabrica {

class TestParameters : public Parameters {
 public:
  using Points = std::vector<std::pair<double, double>>;
  TestParameters(std::initializer_list<std::pair<const std::string, double>> values)
      : values_(values) {}

  double real(std::string_view field) const override {
    const auto it = values_.find(std::string(field));
    return it == values_.end() ? 0.0 : it->second;
  }
  bool given(std::string_view field) const override {
    return values_.count(std::string(field)) > 0;
  }
  CurveView curve(std::string_view field) const override {
    const auto it = curves_.find(std::string(field));
    return it == curves_.end() ? CurveView{} : it->second;
  }
  TableView table(std::string_view field) const override {
    const auto it = tables_.find(std::string(field));
    return it == tables_.end() ? TableView{} : it->second;
  }
  int rows() const override { return int(rows_.size()); }
  double row(int i, std::string_view field) const override {
    return rows_[i].at(std::string(field));
  }

  TestParameters& set(const std::string& field, double value) {
    values_[field] = value;
    return *this;
  }
  TestParameters& set_curve(const std::string& field, const Points& points) {
    curves_[field] = own(points);
    return *this;
  }
  TestParameters& set_table(const std::string& field,
                            const std::vector<std::pair<double, Points>>& curves, bool log_rate) {
    table_curves_.emplace_back();
    numbers_.emplace_back();
    std::vector<CurveView>& views = table_curves_.back();
    std::vector<Real>& rates = numbers_.back();
    for (const auto& [rate, points] : curves) rates.push_back(Real(rate));
    const Real* first = rates.data();
    for (const auto& [rate, points] : curves) views.push_back(own(points));
    tables_[field] = {first, views.data(), int(views.size()), log_rate};
    return *this;
  }
  TestParameters& add_row(std::map<std::string, double> row) {
    rows_.push_back(std::move(row));
    return *this;
  }

 private:
  CurveView own(const Points& points) {
    numbers_.emplace_back();
    for (const auto& [x, y] : points) numbers_.back().push_back(Real(x));
    const Real* x = numbers_.back().data();
    numbers_.emplace_back();
    for (const auto& [a, y] : points) numbers_.back().push_back(Real(y));
    return {x, numbers_.back().data(), int(points.size()), true};
  }
  std::map<std::string, double> values_;
  std::map<std::string, CurveView> curves_;
  std::map<std::string, TableView> tables_;
  std::deque<std::vector<Real>> numbers_;
  std::deque<std::vector<CurveView>> table_curves_;
  std::vector<std::map<std::string, double>> rows_;
};

}  // namespace fabrica
