#pragma once

namespace slipstick::solver {

/// A value over its unit, as models hold it: rounded to 40 bits. Twelve digits are more than any scene's data
/// have, and the roundings that came in with the scene's units, which conjugate gradients would amplify, are
/// gone.
double to_dimensionless(double value, double unit);

}  // namespace slipstick::solver
