#pragma once
// Lays out curves as a chart: axes with round numbers, grid, labels, legend.
#include <vector>

#include "result/drawing.h"
#include "result/plot.h"

namespace fabrica {

Drawing make_chart(const PlotOptions& options, const std::vector<PlotCurve>& curves);

// Round numbers that span [low, high] with about `count` steps of 1, 2 or 5 times a power of ten.
std::vector<double> round_ticks(double low, double high, int count);

}  // namespace fabrica
