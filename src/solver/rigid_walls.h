#pragma once
// Rigid walls. Free nodes are treated kinematically: a node that would be behind the wall after the
// step loses its velocity relative to the wall along the normal, and tangential velocity by
// Coulomb's law:
//   m (v+ - v) = J,  J.n = m dv_n,  |J_t| = min(m |v_t|, mu m dv_n) (mu >= 1: stick)
//   moving wall: V+ = (M V + sum m v_n) / (M + sum m)
// Nodes of rigid bodies get a penalty force k = s 0.1 m/dt^2 (s: RWPNAL, 1 where the deck gives 0).
// WallMethod::constraint stops free nodes at planes a step later, as LS-DYNA's walls are described
// to: a node found behind the plane is put back on it and loses its velocity along the normal, and
// friction knows only the velocity with which it came. See docs/theory/rigid_walls.md.
#include <cstdint>
#include <istream>
#include <ostream>
#include <vector>

#include "base/diagnostics.h"
#include "base/team.h"
#include "constraint/wall.h"
#include "model/model.h"
#include "model/state.h"
#include "model/wall_method.h"

namespace fabrica {

class RigidWalls {
 public:
  // owners of nodes must be known
  RigidWalls(const Model& model, const State& state, Diagnostics& diagnostics,
             WallMethod method = WallMethod::impulse);
  // Adds penalty forces on nodes of rigid bodies to state.interaction; before assembly. max_speed:
  // a bound of nodal speeds at t(n-1/2) and t(n+1/2) so far; negative: computed here.
  void forces(State& state, Team& team, double max_speed = -1);
  // Corrects v+ of free nodes (x still at t(n)) and moves the walls. max_speed: bound of |v+|;
  // negative: computed.
  void apply(State& state, Team& team, double max_speed = -1);

  int size() const { return int(walls_.size()); }
  WallMethod method() const { return method_; }
  // Force of the nodes on the wall in the last cycle, global components.
  const Vec3d& force(int wall) const { return walls_[wall].force; }
  // Its part against the wall's normal, positive in compression (planes).
  double normal_force(int wall) const {
    return -dot(walls_[wall].force, walls_[wall].geometry.normal);
  }
  const Vec3d& velocity(int wall) const { return walls_[wall].velocity; }
  const Vec3d& displacement(int wall) const { return walls_[wall].displacement; }

  // Highest |v| of all nodes, equal for any number of threads.
  static double highest_speed(const State& state, Team& team);

  void save(std::ostream& out) const;
  void load(std::istream& in);

 private:
  struct Hit {
    int node;
    Vec3d normal, v_before;  // v(n-1/2)
    double added;            // least velocity to add along the normal at the wall's old velocity
    bool deep;               // behind before the step
    double braked = 1e300;   // most of that velocity that friction may count
    double back = 0;         // way along the normal by which the node is put back
  };
  struct Side {  // nodes in chunks with bounds of their distance
    std::vector<int> nodes;
    std::vector<double> clearance;
  };
  struct Wall {
    int index = -1;
    WallGeometry geometry;  // at the start
    Vec3d displacement{}, velocity{}, force{}, penalty{};
    Side free, rigid;
    std::vector<Vec3d> last;           // penalty forces of the last cycle, per rigid node
    std::vector<std::uint8_t> welded;  // per free node of walls that weld (FRIC 2, 3)
    Vec3d axis_a{}, axis_b{};          // of orthotropic friction
    double stiffness_dt = 0;
    double pending = 0;
  };
  struct Sums {
    Vec3d impulse{};
    double mass = 0, momentum = 0, before = 0, after = 0;
  };
  void set_friction_axes(const RigidWall& w, Wall& wall) const;
  Vec3d friction_cut(const Wall& wall, const Vec3d& slip, double dvn) const;
  void weld(Wall& wall, const WallGeometry& g, const State& state, int i, Hit& hit) const;
  WallGeometry now(const Wall& wall) const;
  Vec3d driven_velocity(const Wall& wall, const State& state) const;
  bool find(const Wall& wall, const WallGeometry& g, const State& state, int node,
            double& clearance, Hit& hit) const;
  bool find_ahead(const Wall& wall, const WallGeometry& g, const State& state, int node,
                  Hit& hit) const;
  bool find_behind(const Wall& wall, const WallGeometry& g, const State& state, int node,
                   Hit& hit) const;
  void find_near(Side& side, double reach);
  template <class Visit>
  void for_near(Team& team, const Visit& visit) const;
  void detect(Wall& wall, const WallGeometry& g, State& state, Team& team, double speed);
  void push(Wall& wall, State& state, Team& team, double old_speed);
  void penalty(Wall& wall, State& state, Team& team, double speed);

  const Model& model_;
  WallMethod method_;
  std::vector<Wall> walls_;
  std::vector<std::vector<Hit>> hits_;  // per chunk
  std::vector<Sums> sums_;
  std::vector<int> near_;  // chunks of the wall and side at hand
};

}  // namespace fabrica
