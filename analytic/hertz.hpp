#pragma once

namespace slipstick::analytic {

/// Hertz's circular contact (Johnson 1985, section 4.2).
struct HertzCircle {
  double radius;         ///< a, m
  double peak_pressure;  ///< p0, Pa
  double approach;       ///< m
};

/// Sphere of radius R (m) pressed by W (N); E* (Pa), 1/E* = sum of (1 - nu_i^2)/E_i.
/// Throws std::domain_error unless all three are positive and finite.
HertzCircle hertz_circle(double load, double sphere_radius, double effective_modulus);

/// Hertz's elliptic contact: semi-axis_1 along x1, where the relative radius of curvature is radius_1.
struct HertzEllipse {
  double semi_axis_1;
  double semi_axis_2;
  double peak_pressure;
  double approach;
};

/// Gap x1^2/(2 R_1) + x2^2/(2 R_2) pressed by W. Exact (no approximation of the ellipticity): root of the
/// transcendental equation for the axis ratio. Throws std::domain_error unless all are positive and finite.
HertzEllipse hertz_ellipse(double load, double radius_1, double radius_2, double effective_modulus);

}  // namespace slipstick::analytic
