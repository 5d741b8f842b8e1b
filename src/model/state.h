#pragma once
// The state of a run that solver modules share: node motion, forces, energies, time.
// Element history and contact history live with the modules that own them.
#include <cstdint>
#include <vector>

#include "base/aligned.h"
#include "base/fixed_point.h"
#include "base/kahan.h"
#include "base/tensor.h"

namespace fabrica {

// One cache line per node. A tile turns it into a 32-byte float record with one subtract and one
// conversion.
struct alignas(64) NodeMotion {
  Vec3d x;      // position at t(n)
  Vec3d v;      // velocity at t(n-1/2)
  double mass;  // with added mass; never zero
  double inverse_mass;
};
static_assert(sizeof(NodeMotion) == 64);

// Rotation of nodes that carry shells or beams.
struct alignas(64) NodeSpin {
  Vec3d w;         // angular velocity at t(n-1/2), global components
  double inertia;  // lumped scalar rotary inertia; 0: the node has no rotation
  double q[4];     // rotation since the start (w, x, y, z), unit quaternion
};
static_assert(sizeof(NodeSpin) == 64);

// Who moves a node. A node has exactly one owner.
enum class NodeOwner : std::uint8_t {
  free,   // f = m a
  rigid,  // a rigid body or nodal rigid body places it
  tied,   // interpolated from a segment
};

// All energies accumulate over the run, in double.
struct Energies {
  double kinetic = 0, internal = 0, hourglass = 0;
  double contact = 0;  // sliding interface energy
  double contact_friction = 0;
  double rigid_wall = 0;  // stonewall energy
  double damping = 0;     // system damping
  double discrete = 0;    // springs and dampers
  double joint = 0;
  double external_work = 0;
  double eroded_kinetic = 0, eroded_internal = 0, eroded_hourglass = 0;
  double added_mass = 0;  // kinetic energy brought in by mass added to moving nodes
  double initial = 0;     // total at the start
  double total() const {
    return kinetic + internal + hourglass + contact + rigid_wall + damping + discrete + joint +
           eroded_kinetic + eroded_internal + eroded_hourglass;
  }
  // total / (initial + external work); 1 when nothing is lost
  double ratio() const {
    const double in = initial + external_work + added_mass;
    return in != 0 ? total() / in : 1.0;
  }
};

struct State {
  double time = 0;
  KahanSum time_sum;  // what `time` is the value of
  std::int64_t cycle = 0;
  double dt = 0;           // step from t(n) to t(n+1)
  double dt_previous = 0;  // step from t(n-1) to t(n)
  AlignedVector<NodeMotion> nodes;
  AlignedVector<NodeSpin> spins;  // empty if no element has rotations; else one per node
  std::vector<Vec3d> force;       // sum at t(n), after assembly
  std::vector<Vec3d> moment;      // same size as spins
  std::vector<NodeOwner> owner;
  FixedVectors interaction;  // forces of contacts, joints, springs, loads: added by any thread,
                             // taken by assembly
  FixedVectors interaction_moment;    // same size as spins
  std::vector<double> physical_mass;  // without added mass: what gravity acts on
  Energies energy;
  double mean_dt() const { return 0.5 * (dt + dt_previous); }
};

}  // namespace fabrica
