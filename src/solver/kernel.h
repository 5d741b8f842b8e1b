#pragma once
// An element kernel bound to a material law, as the drivers call it: once per tile, never per
// element.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "element/kernel.h"
#include "model/model.h"
#include "model/state.h"

namespace fabrica {

// Node data of a tile relative to its anchor node: x, y, z, vx, vy, vz, mass, unused.
struct alignas(8 * sizeof(Real)) NodeRecord {
  Real value[8];
};
// angular velocity and padding
struct alignas(4 * sizeof(Real)) SpinRecord {
  Real value[4];
};
// partial sum of forces or moments of one (tile, node)
struct alignas(4 * sizeof(Real)) ForceRecord {
  Real value[4];
};

// energies of one element since the start, until it fails
struct ElementEnergy {
  double internal = 0, hourglass = 0;
  bool failed = false;
};

// Nodes of the tile that is likely to come next on this thread, asked for in even shares while the
// blocks of this tile are computed.
struct NodesAhead {
  const int* node = nullptr;
  int count = 0;
  const NodeMotion* motion = nullptr;
  const NodeSpin* spin = nullptr;  // or null
  // share b of `shares`
  void fetch(int b, int shares) const {
    const int first = int(std::int64_t(count) * b / shares),
              last = int(std::int64_t(count) * (b + 1) / shares);
    for (int k = first; k < last; ++k) __builtin_prefetch(motion + node[k], 0, 2);
    if (spin)
      for (int k = first; k < last; ++k) __builtin_prefetch(spin + node[k], 0, 2);
  }
};

// What one call works on. Blocks of block_size elements; the last block may be padded with copies
// of the tile's last element whose forces are dropped.
struct TileView {
  int count = 0;                                // elements
  const std::uint16_t* connectivity = nullptr;  // [block][corner][block_size], local node numbers
  Real* state = nullptr;                        // [block][field][block_size]
  const NodeRecord* nodes = nullptr;
  const SpinRecord* spins = nullptr;
  ForceRecord* force = nullptr;   // per local node, accumulated
  ForceRecord* moment = nullptr;  // per local node, only for elements with rotations
  // nodal-pressure elements: per local node averaged volume rate and pressure, or null
  const Real* node_rate = nullptr;
  const Real* node_pressure = nullptr;
  NodesAhead ahead;
  // set-up only
  const float* thickness = nullptr;    // [element][4]
  const Vec3d* orientation = nullptr;  // [element]
  // results
  double internal = 0, hourglass = 0, damping = 0;  // energy increments
  Real time_step = 0;                               // smallest of the tile
  Real smallest_volume = 0;
  Real* element_time_step = nullptr;  // [block][block_size] or null
  Real* element_alive = nullptr;      // likewise
  // of elements that may fail: what each has taken up so far, [block][block_size], or null
  ElementEnergy* element_energy = nullptr;
  double eroded_internal = 0, eroded_hourglass = 0;  // of elements that fail now
  int failed = 0;                                    // how many those are
};

// What output wants to know of one element, in global axes.
struct ElementReadout {
  int layers = 1;
  Sym3<double> stress[max_layers];
  double plastic_strain[max_layers] = {};
  double thickness = 0;
  double resultants[8] =
      {};  // shells: mxx myy mxy qx qy nxx nyy nxy; beams: axial, shear s, t, moment s, t, torsion
  double alive = 1;
};

// Asks memory for the history of a block, one cache line per field, before its turn comes. A block
// takes longer to compute than its lines take to arrive, and no processor looks that far ahead.
inline void fetch_history(const Real* block, int fields) {
  for (int f = 0; f < fields; ++f) __builtin_prefetch(block + f * block_size, 1);
}

class Kernel {
 public:
  virtual ~Kernel() = default;
  virtual int corners() const = 0;
  virtual bool rotations() const = 0;
  virtual bool can_fail() const = 0;  // with the parameters of its law
  virtual bool nodal_pressure() const { return false; }
  // first pass of nodal-pressure elements, see solver/cpu/nodal_tet.h
  virtual void nodal_rates(const ElementParameters&, Real, TileView&) const {}
  virtual int state_fields(const ElementParameters&) const = 0;
  virtual void initialise(const ElementParameters&, TileView&) const = 0;
  virtual void forces(const ElementParameters&, Real dt_previous, TileView&) const = 0;
  // lumped mass and rotary inertia of one element; x: corners in double
  virtual void lump(const ElementParameters&, const Vec3d* x, const double* thickness,
                    const Vec3d& orientation, double* mass, double* inertia) const = 0;
  // block: state of the element's block; lane: its place in it; x: corner positions
  virtual void read(const ElementParameters&, const Real* block, int lane, const Vec3d* x,
                    ElementReadout&) const = 0;
  virtual Elastic elastic() const = 0;
};

enum class ElementKind {
  hex8,
  hex8_exact,
  hex8_full,
  tet4,
  tet4_nodal,
  penta6,
  shell_bt,
  shell_triangle,
  shell_full,
  membrane,
  membrane_full,
  truss,
  beam_resultant,
  beam_hughes_liu
};

// Makes the kernel of an element kind and a material card; throws std::invalid_argument with a
// reason that a user understands when the law cannot be used in that element.
std::unique_ptr<Kernel> make_kernel(ElementKind kind, const Material& material,
                                    const Parameters& parameters, const Parameters* eos);
std::unique_ptr<Kernel> make_solid_kernel(ElementKind, const Material&, const Parameters&,
                                          const Parameters* eos);
std::unique_ptr<Kernel> make_shell_kernel(ElementKind, const Material&, const Parameters&);
std::unique_ptr<Kernel> make_beam_kernel(ElementKind, const Material&, const Parameters&);

}  // namespace fabrica
