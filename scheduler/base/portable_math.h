// Elementary functions whose results do not depend on the kind of CPU.
//
// glibc picks other code for double sin, cos, exp, log and pow on CPUs with fused multiply-add, and
// the last bit may differ. Its long double functions have one version on x86-64; rounding their
// 64-bit significand to double hides their own last-bit errors nearly always. Everything that ends
// in a frame spec computes with these, so frame ids are the same on every x86-64 machine.
#pragma once

#include <cmath>

namespace seedframe::portable {

inline constexpr double kPi = 3.14159265358979323846;

inline double sin(double x) { return static_cast<double>(sinl(x)); }
inline double cos(double x) { return static_cast<double>(cosl(x)); }
inline double tan(double x) { return static_cast<double>(tanl(x)); }
inline double asin(double x) { return static_cast<double>(asinl(x)); }
inline double acos(double x) { return static_cast<double>(acosl(x)); }
inline double atan(double x) { return static_cast<double>(atanl(x)); }
inline double atan2(double y, double x) { return static_cast<double>(atan2l(y, x)); }
inline double exp(double x) { return static_cast<double>(expl(x)); }
inline double log(double x) { return static_cast<double>(logl(x)); }
inline double pow(double x, double y) { return static_cast<double>(powl(x, y)); }
inline double sqrt(double x) { return std::sqrt(x); }  // correctly rounded by IEEE 754

inline double radians(double degrees) { return degrees * (kPi / 180.0); }

}  // namespace seedframe::portable
