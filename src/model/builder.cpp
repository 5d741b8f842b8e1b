// Staging: what readers and generators hand over, kept with user ids until finish().
#include "model/resolve.h"

namespace fabrica {

void Builder::reserve_nodes(std::size_t n) {
  Nodes& nodes = model_->nodes;
  nodes.id.reserve(n), nodes.x.reserve(n);
  nodes.translation_code.reserve(n), nodes.rotation_code.reserve(n);
  staging_.node_where.reserve(n);
}

void Builder::add_node(std::int64_t id, Vec3d x, int tc, int rc, Location where) {
  Nodes& nodes = model_->nodes;
  nodes.id.push_back(id);
  nodes.x.push_back(x);
  nodes.translation_code.push_back(std::uint8_t(tc));
  nodes.rotation_code.push_back(std::uint8_t(rc));
  staging_.node_where.push_back(where);
}

void Builder::add_solid(std::int64_t id, std::int64_t part, const std::int64_t* nodes, int count,
                        Location where) {
  std::array<std::int64_t, 10> n{};
  for (int i = 0; i < count && i < 10; ++i) n[i] = nodes[i];
  // a tetrahedron by four nodes: as a brick that repeats the fourth
  if (n[4] == 0) n[4] = n[5] = n[6] = n[7] = n[3];
  model_->solids.id.push_back(id);
  staging_.solid_part.push_back(part);
  staging_.solid_nodes.push_back(n);
  staging_.solid_where.push_back(where);
}

void Builder::add_shell(std::int64_t id, std::int64_t part, const std::int64_t* nodes, int count,
                        const double* thickness, double beta, Location where) {
  Shells& shells = model_->shells;
  std::array<std::int64_t, 4> n{};
  for (int i = 0; i < count && i < 4; ++i) n[i] = nodes[i];
  if (n[3] == 0) n[3] = n[2];
  shells.id.push_back(id);
  staging_.shell_part.push_back(part);
  staging_.shell_nodes.push_back(n);
  staging_.shell_where.push_back(where);

  // thickness and angle are stored from the first element that has them
  const std::size_t size = shells.id.size();
  if (thickness || !shells.thickness.empty()) {
    shells.thickness.resize(size);
    if (thickness)
      for (int i = 0; i < 4; ++i) shells.thickness.back()[i] = float(thickness[i]);
  }
  if (beta != 0 || !shells.beta.empty()) {
    shells.beta.resize(size);
    shells.beta.back() = float(beta);
  }
}

void Builder::add_beam(std::int64_t id, std::int64_t part, std::int64_t n1, std::int64_t n2,
                       std::int64_t n3, const Vec3d* orientation, Location where) {
  Beams& beams = model_->beams;
  beams.id.push_back(id);
  staging_.beam_part.push_back(part);
  staging_.beam_nodes.push_back({n1, n2, n3});
  staging_.beam_where.push_back(where);
  if (orientation || !beams.orientation.empty()) {
    beams.orientation.resize(beams.id.size(), Vec3d{0, 0, 0});
    if (orientation) beams.orientation.back() = *orientation;
  }
}

void Builder::add_discrete(std::int64_t id, std::int64_t part, std::int64_t n1, std::int64_t n2,
                           std::int64_t orientation, double scale, double offset, Location where) {
  Discretes& discretes = model_->discretes;
  discretes.id.push_back(id);
  discretes.scale.push_back(scale != 0 ? scale : 1);
  discretes.offset.push_back(offset);
  staging_.discrete_part.push_back(part);
  staging_.discrete_nodes.push_back({n1, n2, orientation});
  staging_.discrete_where.push_back(where);
}

void Builder::add_mass(std::int64_t id, std::int64_t node, double mass, std::int64_t part,
                       Location where) {
  model_->masses.push_back({id, -1, mass, -1});
  staging_.mass_node.push_back(node);
  staging_.mass_part.push_back(part);
  staging_.mass_where.push_back(where);
}

void Builder::add_inertia(std::int64_t id, std::int64_t node, double mass,
                          const std::array<double, 6>& inertia, Location where) {
  model_->inertias.push_back({id, -1, mass, inertia});
  staging_.inertia_node.push_back(node);
  staging_.inertia_where.push_back(where);
}

Card& Builder::add_card(Card card) {
  model_->cards.push_back(std::make_unique<Card>(std::move(card)));
  return *model_->cards.back();
}

void Builder::set_title(std::string title) { model_->title = std::move(title); }

std::unique_ptr<Model> Builder::finish() {
  Resolver(*this).run();
  staging_ = {};
  return std::move(model_);
}

}  // namespace fabrica
