#pragma once
// What a run hands to the writers: plain arrays, in the order of the model's entities. The solver
// fills them, `result` writes them, and neither sees the other.
#include <cstdint>
#include <string>
#include <vector>

namespace fabrica {

// One time-history database ("glstat", "elout/shell", "jntforc/joints"): what it holds never
// changes in a run.
struct HistoryVariable {
  std::string name;  // LS-DYNA's name: "kinetic_energy"
  int length = 1;    // values per state
  bool integer = false;
};
struct HistoryDatabase {
  std::string path;  // "nodout", "elout/solid", ...
  double interval = 0;
  std::vector<std::int64_t> ids;    // metadata/ids, empty if the database has none
  std::vector<std::string> legend;  // one per id, may be empty
  std::vector<std::pair<std::string, std::string>>
      text_metadata;  // e.g. {"element_types", "shell"}
  std::vector<std::pair<std::string, std::vector<std::int64_t>>>
      integer_metadata;                    // e.g. {"side", {0, 1}}
  std::vector<HistoryVariable> variables;  // "time" and "cycle" are implied and must not be listed
};
struct HistorySample {
  double time = 0;
  int cycle = 0;
  std::vector<std::vector<double>> values;  // one per variable
};

// One animation state. Sizes follow the model: n nodes, solids, shells, beams, discretes, parts.
struct AnimationState {
  double time = 0;
  std::vector<float> position, velocity, acceleration;  // 3 per node
  std::vector<float> solid_stress;                      // 6 per solid (xx yy zz xy yz zx), global
  std::vector<float> solid_plastic_strain;              // 1 per solid
  std::vector<float> solid_strain;                      // 6 per solid or empty
  int shell_layers = 3;                                 // mid, inner, outer
  std::vector<float> shell_stress;                      // shell_layers * 6 per shell
  std::vector<float> shell_plastic_strain;              // shell_layers per shell
  std::vector<float> shell_resultants;      // 8 per shell: mxx myy mxy qx qy nxx nyy nxy
  std::vector<float> shell_thickness;       // 1 per shell
  std::vector<float> shell_energy_density;  // 1 per shell
  std::vector<float> shell_strain;          // 12 per shell (inner 6, outer 6) or empty
  std::vector<float>
      beam_resultants;  // 6 per beam: axial, shear s, shear t, moment s, moment t, torsion
  std::vector<float> discrete_force;                               // 1 per discrete element
  std::vector<std::uint8_t> solid_alive, shell_alive, beam_alive;  // empty: all alive
  // globals
  double kinetic_energy = 0, internal_energy = 0, total_energy = 0;
  double momentum_velocity[3] = {0, 0, 0};
  std::vector<double> part_internal_energy, part_kinetic_energy, part_mass,
      part_hourglass_energy;          // per part
  std::vector<double> part_velocity;  // 3 per part
  std::vector<double> wall_force;     // per rigid wall
};

}  // namespace fabrica
