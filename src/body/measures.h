#pragma once
// What a body measures: the rows of `measures.md`, each with the figure, what it must be, and
// whether it is.
#include <string>
#include <vector>

#include "body/assembly.h"
#include "body/body.h"
#include "model/check.h"

namespace fabrica::body {

// figures that only others can find: contacts need the solver, time the caller
struct OutsideMeasures {
  int penetrating_nodes = 0, untied_nodes = 0;
  double largest_penetration = 0;  // [mm]
  std::string penetrations;        // contacts with the worst, each with its node and depth
  double seconds = 0;              // to make the body
  bool searched = false;           // contacts were searched
};

struct Measure {
  std::string figure, value, must;
  bool holds = true;
  bool required = true;  // false: reported only
};

struct Quality {
  double min_jacobian = 1, p1_jacobian = 1, min_size = 1e9;  // scaled Jacobian [-]; size [mm]
  std::string where_jacobian, where_size;                    // bone or piece
  int bricks = 0;
};
// of all bricks of bones and pieces where they stand
Quality brick_quality(const Body& body);

// Measures the body as assembled: nodes where joints have moved them.
std::vector<Measure> measure_body(const Body& body, const AssembledBody& assembled,
                                  const Model& model, const CheckReport& check,
                                  const OutsideMeasures& outside);
// The table of measures, then every bone, the twenty smallest elements, and every part with its
// material and source.
std::string measures_text(const Body& body, const AssembledBody& assembled, const Model& model,
                          const CheckReport& check, const OutsideMeasures& outside);

}  // namespace fabrica::body
