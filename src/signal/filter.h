#pragma once
// SAE J211-1 / ISO 6487 channel frequency classes as digital filters without phase shift.
#include <string>
#include <vector>

#include "signal/curve.h"

namespace fabrica {

// Coefficients of one pass, Y_t = a0 X_t + a1 X_t-1 + a2 X_t-2 + b1 Y_t-1 + b2 Y_t-2.
struct FilterCoefficients {
  double a0, a1, a2, b1, b2;
};

// Two-pole Butterworth of class `cfc` (60, 180, 600, 1000 or any other) for a sample interval in
// seconds. Throws SignalError "sampling-too-slow" below the 10 CFC samples a second for which the
// class is defined.
FilterCoefficients cfc_coefficients(double cfc, double interval_s);

// Gain of the forward and backward pass at a frequency [Hz].
double cfc_gain(const FilterCoefficients& c, double frequency, double interval_s);

// CFC60, CFC180, CFC600, CFC1000: the classes that the standards name
const std::vector<std::string>& cfc_names();
// 60 of "CFC60"
double cfc_of(const std::string& name);

// The signal filtered forward and backward; x_unit must be a time, samples at a constant step.
Signal cfc_filtered(const Signal& signal, double cfc);

}  // namespace fabrica
