// Look-ups by user id, and the parameters of a law read from its card.
#include "model/model.h"

namespace fabrica {
namespace {

int find(const std::unordered_map<std::int64_t, int>& map, std::int64_t id) {
  const auto it = map.find(id);
  return it == map.end() ? -1 : it->second;
}

}  // namespace

int Model::node_index(std::int64_t id) const { return find(node_map_, id); }
int Model::part_index(std::int64_t id) const { return find(part_map_, id); }
int Model::curve_index(std::int64_t id) const { return find(curve_map_, id); }
int Model::table_index(std::int64_t id) const { return find(table_map_, id); }

double CardParameters::real(std::string_view field) const { return card_.real(field); }
bool CardParameters::given(std::string_view field) const { return card_.given(field); }

CurveView CardParameters::curve(std::string_view field) const {
  // a minus sign tells a curve from a constant
  const int i = model_.curve_index(std::abs(card_.id(field)));
  return i < 0 ? CurveView{} : model_.curves[i].view();
}

TableView CardParameters::table(std::string_view field) const {
  const int i = model_.table_index(card_.id(field));
  if (i < 0) return {};
  const Table& t = model_.tables[i];
  return {t.rate_real.data(), t.views.data(), int(t.views.size()), t.log_rate};
}

int CardParameters::rows() const { return card_.row_count(); }
double CardParameters::row(int i, std::string_view field) const { return card_.row(i, field); }

}  // namespace fabrica
