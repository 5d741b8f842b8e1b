#pragma once
// The catalogue of injury measures: what each needs, how it is filtered and computed, its limit,
// risks and sources; and their evaluation from channels by role.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "signal/curve.h"

namespace fabrica {

// Who is judged, and by which limits.
struct Subject {
  double age = 45;            // [years]
  double chest_depth = 229;   // [mm]
  double vc_factor = 1;       // 1 for a human, 1.3 for the Hybrid III
  double neck_arm = 0;        // e of M_oc = M_y - e F_x [mm]; 17.78 for the Hybrid III
  double csdm_strain = 0.25;  // threshold of CSDM
  double rib_strain = 0.018;  // at which a rib counts as broken
  std::string neck = "H3-50M", leg = "H3-50M";
};
// NAME=VALUE; throws SignalError "unknown-parameter" with the list of names.
void set_parameter(Subject& subject, const std::string& text);

// A number counts as confirmed if it was read in its source or stands alike in independent programs
// or texts (docs/theory/injury.md). `doubt` says what is not; empty where all is.
struct Risk {
  std::string event;
  double probability = 0;
  std::string source, doubt{};
};
struct Finding {
  double value = 0;
  std::string detail;
  std::vector<Risk> risks;
};

// Channels by role: time histories in units of their kind; of tissues, values (y) over volumes (x)
// of the elements, and of ribs strains (y) over rib numbers (x).
using Channels = std::map<std::string, Signal>;

struct Measure {
  std::string name, region, unit;
  std::vector<std::string> roles;  // all are needed
  std::string filter, formula;
  std::optional<double> limit;
  std::string limit_source, source;
  Finding (*evaluate)(const Subject&, const Channels&);
  std::string doubt{};
};
const std::vector<Measure>& measures();

// A measure with its finding, or with the reason why there is none: the roles that are missing, or
// an error.
struct Judged {
  const Measure* measure = nullptr;
  std::optional<Finding> finding;
  std::string reason;
  bool failed = false;  // all channels are there, but the measure cannot be computed from them
};
std::vector<Judged> judge(const Subject& subject, const Channels& channels);

// The role of an ISO-MME channel code (11HEAD0000H3ACXA -> head.ax), or "".
std::string role_of_code(const std::string& code);
// What each role is, by name.
const std::map<std::string, std::string>& roles();

}  // namespace fabrica
