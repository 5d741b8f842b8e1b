// Restart files: every double and every history bit, so that a continued run has the bits of an
// unbroken one.
#include <fstream>
#include <stdexcept>

#include "base/hash.h"
#include "solver/simulation.h"

namespace fabrica {
namespace {

constexpr char magic[8] = {'F', 'A', 'B', 'R', 'S', 'T', '0', '4'};

template <class T>
void put(std::ostream& out, const T& x) {
  out.write(reinterpret_cast<const char*>(&x), sizeof x);
}
template <class T>
void take(std::istream& in, T& x) {
  in.read(reinterpret_cast<char*>(&x), sizeof x);
}
template <class V>
void put_vector(std::ostream& out, const V& v) {
  put(out, std::uint64_t(v.size()));
  out.write(reinterpret_cast<const char*>(v.data()), std::streamsize(v.size() * sizeof(v[0])));
}
template <class V>
void take_vector(std::istream& in, V& v) {
  std::uint64_t n = 0;
  take(in, n);
  if (n != v.size())
    throw std::runtime_error("the restart file does not belong to this deck: sizes differ");
  in.read(reinterpret_cast<char*>(v.data()), std::streamsize(n * sizeof(v[0])));
}

}  // namespace

std::uint64_t Simulation::state_hash() const {
  Hash h;
  for (const NodeMotion& n : state_.nodes) h.bytes(&n.x, 6 * sizeof(double));
  return h.value();
}

// Writes the state after a whole step to a file; throws std::runtime_error when that fails.
void Simulation::save(const std::string& path) const {
  const std::string part = path + ".part";
  {
    std::ofstream out(part, std::ios::binary);
    out.write(magic, sizeof magic);
    put(out, int(sizeof(Real)));
    put(out, model_.content_hash());
    put(out, state_.time), put(out, state_.time_sum), put(out, state_.cycle), put(out, state_.dt),
        put(out, state_.dt_previous);
    put(out, state_.energy), put(out, initial_step_), put(out, energy_started_);
    put_vector(out, state_.nodes), put_vector(out, state_.spins), put_vector(out, state_.owner);
    put_vector(out, part_internal_), put_vector(out, part_hourglass_);
    put_vector(out, part_eroded_internal_);
    tiles_.save(out);
    mass_scaling_.save(out);
    rigid_bodies_->save(out), joints_->save(out), node_constraints_->save(out),
        rigid_walls_->save(out);
    loads_->save(out), damping_->save(out), discrete_->save(out), contacts_->save(out);
    out.flush();
    if (!out) throw std::runtime_error("cannot write the restart file " + path);
  }
  if (std::rename(part.c_str(), path.c_str()) != 0)
    throw std::runtime_error("cannot write the restart file " + path);
}

// Continues from a file that save() wrote for the same deck and precision; throws
// std::runtime_error otherwise.
void Simulation::load(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  char head[8] = {};
  int real = 0;
  std::uint64_t hash = 0;
  in.read(head, sizeof head);
  take(in, real), take(in, hash);
  if (!in || std::string(head, 8) != std::string(magic, 8))
    throw std::runtime_error(path + " is not a restart file of this version");
  if (real != int(sizeof(Real)))
    throw std::runtime_error(path + " was written by a build of the other precision");
  if (hash != model_.content_hash()) throw std::runtime_error(path + " belongs to another deck");
  take(in, state_.time), take(in, state_.time_sum), take(in, state_.cycle), take(in, state_.dt),
      take(in, state_.dt_previous);
  take(in, state_.energy), take(in, initial_step_), take(in, energy_started_);
  take_vector(in, state_.nodes), take_vector(in, state_.spins), take_vector(in, state_.owner);
  take_vector(in, part_internal_), take_vector(in, part_hourglass_);
  take_vector(in, part_eroded_internal_);
  tiles_.load(in);
  erosion_.restore(tiles_);
  mass_scaling_.load(in);
  rigid_bodies_->load(in), joints_->load(in), node_constraints_->load(in), rigid_walls_->load(in);
  loads_->load(in), damping_->load(in), discrete_->load(in), contacts_->load(in);
  if (!in) throw std::runtime_error(path + " is cut short");
}

}  // namespace fabrica
