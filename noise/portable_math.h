// Elementary functions with the same bits on every machine: additions, multiplications and divisions only. A
// libm picks its code by processor, and a last bit of a drawn parameter would change a clip.
#pragma once

namespace shimmer::noise {

double Exp(double x);        // relative error < 4e-16; 0 below -745, infinite above 709.8
double Log(double x);        // x > 0 and normal; absolute error < 4e-16 max(1, |log x|)
double Cos(double x);        // |x| < 1000; absolute error < 4e-16 max(1, |x|)
double NormalCdf(double x);  // Phi: integral of the standard normal density up to x; absolute error < 1e-15
double NormalQuantile(double p);  // Phi's inverse, p in (0, 1); within [-8.3, 8.3]

}  // namespace shimmer::noise
