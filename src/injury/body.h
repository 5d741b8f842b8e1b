#pragma once
// Measures of neck, thorax and legs from forces, moments and deflections. Signs after SAE J211:
// tension and flexion positive, compression and extension negative.
//   Nij = F_z / F_int + M_oc / M_int, M_oc = M_y - e F_x                     (Eppinger et al. 1999,
//   NHTSA) VC  = s V C, C = D / D_ref, V = dD/dt by five points                     (Lau and Viano
//   1986; Euro NCAP TB 021) CTI = A_max / A_int + D_max / D_int, A_max the 3 ms clip (Kleinberger
//   et al. 1998, NHTSA) TI  = sqrt(M_x^2 + M_y^2) / M_c + |F_z| / F_c (Mertz 1993; Euro NCAP TB
//   021)
#include <string>

#include "signal/curve.h"

namespace fabrica {

struct NeckIntercepts {
  std::string name;
  double tension, compression;  // [N], compression negative
  double flexion, extension;    // [N m], extension negative
};
// "H3-50M", "H3-05F", "THOR-50M"; throws SignalError "unknown-set".
NeckIntercepts neck_intercepts(const std::string& name);

// Largest of each of the four cases over time, and of all.
struct Nij {
  double tension_flexion = 0, tension_extension = 0, compression_flexion = 0,
         compression_extension = 0;
  double largest() const;
};
Nij nij(const Signal& axial_force, const Signal& occipital_moment, const NeckIntercepts& set);

// M_y - e F_x, e in metres.
Signal occipital_moment(const Signal& moment, const Signal& shear_force, double e);

// [m/s]; deflection D in units of length, reference depth in metres, factor s.
double viscous_criterion(const Signal& deflection, double reference_depth, double factor);

// Intercepts 85 g and 102 mm are those of the Hybrid III 50M.
double combined_thoracic_index(double clip_g, double deflection_mm, double intercept_g = 85,
                               double intercept_mm = 102);

struct TibiaLimits {
  std::string name;
  double moment, force;  // [N m], [N]
};
// "H3-50M", "THOR-50M", "H3-05F", "H3-95M", "revised"; throws SignalError "unknown-set".
TibiaLimits tibia_limits(const std::string& name);
double tibia_index(const Signal& moment_x, const Signal& moment_y, const Signal& axial_force,
                   const TibiaLimits& set);

double largest_magnitude(const Signal& signal);
// Largest -y: compression where compression is negative; 0 if there is none.
double largest_compression(const Signal& signal);

}  // namespace fabrica
