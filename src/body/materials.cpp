#include "body/materials.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "body/cards.h"

namespace fabrica::body {
namespace {

constexpr double per_ms = 1000;  // [1/s]

}  // namespace

Materials::Materials(Builder& builder, bool fracture)
    : builder_(builder), fracture_(fracture), table_("materials.csv") {
  for (int r = 0; r < table_.rows(); ++r) row_of_[table_.text(r, "row")] = r;
}

Card& Materials::card(const std::string& keyword, const std::string& title) {
  Card& card = titled(builder_, keyword.c_str(), title);
  card.set("mid", double(++last_material_));
  return card;
}

std::int64_t Materials::next_curve(const std::string& title,
                                   const std::vector<std::pair<double, double>>& points) {
  add_curve(builder_, ++last_curve_, title, points);
  return last_curve_;
}

std::int64_t Materials::use(const std::string& row) {
  if (const auto made = ids_.find(row); made != ids_.end()) return made->second;
  const auto at = row_of_.find(row);
  if (at == row_of_.end()) throw BodyError(fmt::format("data/materials.csv has no row '{}'", row));
  const int r = at->second;
  Card& c = card(table_.text(r, "keyword"), table_.text(r, "tissue"));
  std::istringstream fields(table_.text(r, "fields"));
  for (std::string item; fields >> item;) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos || !c.has_field(item.substr(0, equals)))
      table_.fail(r, fmt::format("'{}' is no field of {}; write field=value", item,
                                 table_.text(r, "keyword")));
    c.set(item.substr(0, equals), std::atof(item.c_str() + equals + 1));
  }
  // fracture: `delete` acts in every run, `strain` where asked for
  const std::string& criterion = table_.text(r, "criterion");
  const char* field = c.has_field("fail") ? "fail" : "fs";
  if (criterion == "delete") c.set(field, table_.number(r, "value"));
  if (criterion == "strain" && fracture_)
    c.set(field, plastic_strain_at(
                     c, table_.number(r, "value"),
                     table_.text(r, "rate").empty() ? 0 : table_.number(r, "rate") / per_ms));
  return ids_[row] = last_material_;
}

double plastic_strain_at(const Card& law, double strain, double rate) {
  const double E = law.real("e"), yield = law.real("sigy"), tangent = law.real("etan");
  std::vector<std::pair<double, double>> curve;
  for (int i = 1; i <= 8 && law.has_field("eps1"); ++i) {
    const double e = law.real(fmt::format("eps{}", i)), s = law.real(fmt::format("es{}", i));
    if (s > 0) curve.emplace_back(e, s);
  }
  if (curve.size() < 2) curve = {{0, yield}, {1, yield + E * tangent / (E - tangent)}};
  if (rate > 0)
    for (auto& point : curve) point.second *= 1 + std::pow(rate / law.real("c"), 1 / law.real("p"));
  if (curve[0].second >= E * strain) return 0;
  // the piece that holds the root, the last one goes on
  std::size_t i = 0;
  while (i + 2 < curve.size() && curve[i + 1].first + curve[i + 1].second / E < strain) ++i;
  const double slope =
      (curve[i + 1].second - curve[i].second) / (curve[i + 1].first - curve[i].first);
  return (strain - (curve[i].second - slope * curve[i].first) / E) / (1 + slope / E);
}

std::int64_t Materials::add(const std::string& title, const Law& law) {
  std::int64_t curve = 0;
  if (!law.curve_field.empty()) curve = next_curve(title, law.curve);
  Card& c = card(law.keyword, title);
  for (const auto& [field, value] : law.fields) c.set(field, value);
  if (curve) c.set(law.curve_field, double(curve));
  return last_material_;
}

BoneMaterial bone_material(const std::string& bone) {
  static const Table table("anatomy/bone_materials.csv");
  for (int r = 0; r < table.rows(); ++r) {
    const std::string& prefix = table.text(r, "prefix");
    // one letter stands for a vertebra: C, T or L before a number
    const bool vertebra =
        prefix.size() > 1 || (bone.size() > 1 && std::isdigit(static_cast<unsigned char>(bone[1])));
    if (bone.starts_with(prefix) && vertebra)
      return {table.text(r, "cortical"), table.text(r, "trabecular"),
              table.number(r, "rigid_at_coarse") != 0};
  }
  throw BodyError(fmt::format("anatomy/bone_materials.csv has no prefix of bone '{}'", bone));
}

}  // namespace fabrica::body
