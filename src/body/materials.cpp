#include "body/materials.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
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

std::int64_t Materials::next_curve(const std::string& title, const Points& points) {
  add_curve(builder_, ++last_curve_, title, points);
  return last_curve_;
}

// "0:0.1;1:1.2" as pairs
Materials::Points Materials::points(int row, const std::string& item,
                                    const std::string& text) const {
  Points out;
  std::istringstream pairs(text);
  for (std::string pair; std::getline(pairs, pair, ';');) {
    double x = 0, y = 0;
    int end = 0;
    if (std::sscanf(pair.c_str(), "%lf:%lf%n", &x, &y, &end) != 2 ||
        std::size_t(end) != pair.size())
      table_.fail(row, fmt::format("'{}' of '{}' is no pair; write x:y;x:y", pair, item));
    out.emplace_back(x, y);
  }
  return out;
}

// fields of a row on its card; yield: its curve in tension, if it has one
void Materials::fill(int row, Card& card, double faster, Points& yield) {
  const KeywordSchema& schema = *card.schema;
  const auto rate = [](const FieldSchema& f) { return f.unit == "rate" || f.unit == "1/time"; };
  std::istringstream fields(table_.text(row, "fields"));
  for (std::string item; fields >> item;) {
    const std::size_t equals = item.find('=');
    const std::string name = item.substr(0, equals);
    if (equals != std::string::npos && name == "prony" && card.columns() >= 2) {
      for (const auto& [modulus, decay] : points(row, item, item.substr(equals + 1)))
        card.add_row({modulus, faster * decay});
      continue;
    }
    if (equals == std::string::npos || !card.has_field(name))
      table_.fail(row, fmt::format("'{}' is no field of {}; write field=value", item, schema.name));
    if (item.find(':') != std::string::npos) {
      const Points curve = points(row, item, item.substr(equals + 1));
      card.set(name, double(next_curve(table_.text(row, "tissue") + " " + name, curve)));
      if (name == "lcidt") yield = curve;
      continue;
    }
    const double value = std::atof(item.c_str() + equals + 1);
    bool scaled = false;
    for (const CardSchema& c : schema.cards)
      for (const FieldSchema& f : c.fields) scaled = scaled || (f.name == name && rate(f));
    card.set(name, scaled ? faster * value : value);
  }
}

// fracture: `delete` acts in every run, `strain` where asked for
void Materials::let_break(int row, Card& card, double faster, const Points& yield) const {
  const std::string& criterion = table_.text(row, "criterion");
  const char* field = card.has_field("fail") ? "fail" : "fs";
  if (criterion == "delete") card.set(field, table_.number(row, "value"));
  if (criterion != "strain" || !fracture_) return;
  const double strain = table_.number(row, "value");
  if (card.has_field("numint")) card.set("numint", 1);  // a shell breaks with its first layer
  const double rate =
      table_.text(row, "rate").empty() ? 0 : faster * table_.number(row, "rate") / per_ms;
  card.set(field, yield.size() > 1 ? plastic_strain_at(card.real("e"), yield, strain)
                                   : plastic_strain_at(card, strain, rate));
}

std::int64_t Materials::use(const std::string& row, double faster) {
  if (const auto made = ids_.find({row, faster}); made != ids_.end()) return made->second;
  const auto at = row_of_.find(row);
  if (at == row_of_.end()) throw BodyError(fmt::format("data/materials.csv has no row '{}'", row));
  const int r = at->second;
  Card& c = card(table_.text(r, "keyword"), table_.text(r, "tissue"));
  const std::int64_t id = last_material_;
  Points yield;
  fill(r, c, faster, yield);
  let_break(r, c, faster, yield);
  return ids_[{row, faster}] = id;
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
  return plastic_strain_at(E, curve, strain);
}

double plastic_strain_at(double E, const std::vector<std::pair<double, double>>& curve,
                         double strain) {
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
