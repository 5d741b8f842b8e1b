#pragma once
// Rows of data/materials.csv as cards of a model: each row becomes one material, made when it is
// first used.
#include <cstdint>
#include <map>
#include <string>

#include "body/piece.h"
#include "body/tables.h"
#include "model/model.h"

namespace fabrica::body {

class Materials {
 public:
  // `fracture`: a criterion in strain deletes elements in the run, see plastic_strain_at
  explicit Materials(Builder& builder, bool fracture = false);
  // id of the material of a row; `faster`: of a test that is run so many times faster than it was
  // done, rates of its law are as many times higher. Throws BodyError when the table has no such
  // row or a field is not of its keyword.
  std::int64_t use(const std::string& row, double faster = 1);
  // id of a new material of a law, with its curve
  std::int64_t add(const std::string& title, const Law& law);

 private:
  using Points = std::vector<std::pair<double, double>>;
  Card& card(const std::string& keyword, const std::string& title);
  Points points(int row, const std::string& item, const std::string& text) const;
  void fill(int row, Card& card, double faster, Points& yield);
  void let_break(int row, Card& card, double faster, const Points& yield) const;
  std::int64_t next_curve(const std::string& title, const Points& points);

  Builder& builder_;
  bool fracture_;
  Table table_;
  std::map<std::string, int> row_of_;
  std::map<std::pair<std::string, double>, std::int64_t> ids_;
  std::int64_t last_material_ = 0, last_curve_ = 0;
};

// The plastic strain e_p at which a bar of a law (*MAT_PIECEWISE_LINEAR_PLASTICITY or
// *MAT_PLASTIC_KINEMATIC) pulled at a strain rate [1/ms], 0 is slowly, reaches a strain e:
//
//   e_p + s(e_p) / E = e,   s = SIGY + E ETAN / (E - ETAN) e_p, or the curve EPS, ES,         (1)
//                               times 1 + (rate / C)^(1/P)
//
// 0 where it is still elastic.
double plastic_strain_at(const Card& law, double strain, double rate = 0);
// The same of a curve s(e_p) of two points or more.
double plastic_strain_at(double youngs, const std::vector<std::pair<double, double>>& curve,
                         double strain);

// materials of a bone, a row of data/anatomy/bone_materials.csv
struct BoneMaterial {
  std::string cortical, trabecular;
  bool rigid_at_coarse = false;
};
// throws BodyError when no prefix fits
BoneMaterial bone_material(const std::string& bone);

}  // namespace fabrica::body
