#pragma once
// Floating point operations of one element and one cycle, counted by running the kernel over a
// number type that counts: +, -, *, / and sqrt are one, fma is two; comparisons and selects are
// none.

namespace fabrica {

double flops_of_brick();  // one point, IHQ 2, J2
double flops_of_tet();    // elastic
double flops_of_shell();  // Belytschko-Tsay, 5 layers, J2

}  // namespace fabrica
