// A hash of what a model is made of: bulk arrays with user ids, and cards. Lines, files and blanks
// do not count.
#include "base/hash.h"

#include "model/model.h"

namespace fabrica {
namespace {

void add_card(Hash& hash, const Card& card) {
  hash.add(std::string_view(card.schema->name));
  for (const std::string& option : card.options) hash.add(std::string_view(option));
  hash.add(std::string_view(card.title));
  for (std::size_t i = 0; i < card.values.size(); ++i) {
    hash.add(std::int64_t(card.values_given[i]));
    hash.add(card.values[i]);
    hash.add(std::string_view(card.texts[i]));
  }
  for (std::size_t i = 0; i < card.table_.size(); ++i) {
    hash.add(std::int64_t(card.table_given_[i]));
    hash.add(card.table_[i]);
    if (i < card.table_texts_.size()) hash.add(std::string_view(card.table_texts_[i]));
  }
}

template <std::size_t N>
void add_nodes(Hash& hash, const Nodes& nodes, const std::array<int, N>& element) {
  for (const int n : element) hash.add(n < 0 ? std::int64_t(0) : nodes.id[std::size_t(n)]);
}

void add_part(Hash& hash, const std::vector<Part>& parts, int part) {
  hash.add(part < 0 ? std::int64_t(0) : parts[std::size_t(part)].id);
}

void add_mesh(Hash& hash, const Model& m) {
  for (std::size_t i = 0; i < m.nodes.id.size(); ++i) {
    hash.add(m.nodes.id[i]);
    for (int k = 0; k < 3; ++k) hash.add(m.nodes.x[i][k]);
    hash.add(std::int64_t(m.nodes.translation_code[i] * 8 + m.nodes.rotation_code[i]));
  }
  for (std::size_t i = 0; i < m.solids.id.size(); ++i) {
    hash.add(m.solids.id[i]);
    add_part(hash, m.parts, m.solids.part[i]);
    add_nodes(hash, m.nodes, m.solids.node[i]);
  }
  for (std::size_t i = 0; i < m.shells.id.size(); ++i) {
    hash.add(m.shells.id[i]);
    add_part(hash, m.parts, m.shells.part[i]);
    add_nodes(hash, m.nodes, m.shells.node[i]);
    for (std::size_t k = 0; k < 4; ++k)
      hash.add(i < m.shells.thickness.size() ? double(m.shells.thickness[i][k]) : 0.0);
    hash.add(i < m.shells.beta.size() ? double(m.shells.beta[i]) : 0.0);
  }
  for (std::size_t i = 0; i < m.beams.id.size(); ++i) {
    hash.add(m.beams.id[i]);
    add_part(hash, m.parts, m.beams.part[i]);
    add_nodes(hash, m.nodes, m.beams.node[i]);
    for (int k = 0; k < 3; ++k)
      hash.add(i < m.beams.orientation.size() ? m.beams.orientation[i][k] : 0.0);
  }
}

void add_points(Hash& hash, const Model& m) {
  for (std::size_t i = 0; i < m.discretes.id.size(); ++i) {
    hash.add(m.discretes.id[i]);
    add_part(hash, m.parts, m.discretes.part[i]);
    add_nodes(hash, m.nodes, m.discretes.node[i]);
    const int o = m.discretes.orientation[i];
    hash.add(o < 0 ? std::int64_t(0) : m.sd_orientations[std::size_t(o)].id);
    hash.add(m.discretes.scale[i]);
    hash.add(m.discretes.offset[i]);
  }
  for (const NodalMass& mass : m.masses) {
    hash.add(mass.id);
    add_nodes(hash, m.nodes, std::array<int, 1>{mass.node});
    hash.add(mass.mass);
    add_part(hash, m.parts, mass.part);
  }
  for (const NodalInertia& inertia : m.inertias) {
    hash.add(inertia.id);
    add_nodes(hash, m.nodes, std::array<int, 1>{inertia.node});
    hash.add(inertia.mass);
    for (const double v : inertia.inertia) hash.add(v);
  }
}

}  // namespace

std::uint64_t Model::content_hash() const {
  Hash hash;
  hash.add(std::string_view(title));
  add_mesh(hash, *this);
  add_points(hash, *this);
  for (const auto& card : cards) add_card(hash, *card);
  return hash.value();
}

}  // namespace fabrica
