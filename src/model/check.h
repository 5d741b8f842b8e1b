#pragma once
// What a model is before it runs: masses, time steps, contacts, and what is wrong with it.
#include <cstdint>
#include <string>
#include <vector>

#include "model/model.h"

namespace fabrica {

struct PartReport {
  std::int64_t id = 0;
  std::string title, law;
  Family family = Family::none;
  int formulation = 0, elements = 0;
  bool rigid = false;
  double mass = 0;
  double time_step = 0;  // smallest of its elements; 0: rigid, or no element has one
};
struct StepReport {
  std::int64_t element = 0, part = 0;
  Family family = Family::none;
  double time_step = 0;
};
struct FormulationCount {
  Family family = Family::none;
  int formulation = 0, elements = 0;
};
struct CheckReport {
  std::vector<PartReport> parts;               // in deck order
  std::vector<FormulationCount> formulations;  // by family, then formulation
  double mass = 0;                             // of elements, nodal masses and *PART_INERTIA
  Vec3d center{0, 0, 0};                       // of mass
  double kinetic_energy = 0;                   // of the initial velocities of nodes
  double moving_mass = 0;                      // of nodes that have an initial velocity
  std::vector<StepReport> smallest;            // up to 20 elements, smallest step first
  std::vector<std::string> contacts;           // a line each
  std::vector<std::string> penetrations;  // filled by whoever searches the contacts, a line each
  int unreferenced_nodes = 0;             // in no element, mass or rigid body
  std::vector<double> node_mass;          // lumped
};

// Measures a model and adds warnings (unreferenced nodes) to the diagnostics. Inverted elements are
// reported when the model is built.
CheckReport check_model(const Model& model, Diagnostics& diagnostics);

// The report and all diagnostics as text. The last line is "check: E errors, U unsupported, I
// ignored, W warnings".
std::string format_check(const CheckReport& report, const Diagnostics& diagnostics);

}  // namespace fabrica
