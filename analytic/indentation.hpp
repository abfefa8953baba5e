#pragma once

namespace slipstick::analytic {

/// Frictionless normal contact of a body of revolution with a half-space (Sneddon 1965), for half-spaces and
/// bodies that both yield with 1/E* = sum of (1 - nu_i^2)/E_i. SI or any consistent units.
struct Indentation {
  double contact_radius;
  double approach;
  double reference_pressure;  ///< the p0 of the profile with this shape's name
};

// Each throws std::domain_error, with name and value, unless all are positive and finite (a flat radius may be 0).

/// Sphere or paraboloid; p0 is the peak (Hertz).
Indentation indent_sphere(double load, double radius, double effective_modulus);

/// Cone, slope the tangent of the angle between its side and the surface; p0 is the mean (Love 1939).
Indentation indent_cone(double load, double slope, double effective_modulus);

/// Flat punch; p0 is the pressure at the centre (Boussinesq).
Indentation indent_flat_punch(double load, double radius, double effective_modulus);

/// Gap coefficient * r^exponent, the coefficient in m^(1 - exponent); p0 is (exponent + 1)/2 of the mean.
Indentation indent_power(double load, double exponent, double coefficient, double effective_modulus);

/// Flat out to a radius, then the gap (r - flat_radius)^2/(2 corner_radius) (Ciavarella 1999); p0 is the mean.
struct RoundedPunchIndentation {
  Indentation contact;
  double flat_ratio;  ///< flat radius over contact radius; 1 where the load does not reach into the corner
};
RoundedPunchIndentation indent_rounded_punch(double load, double flat_radius, double corner_radius,
                                             double effective_modulus);

/// Hertz's elliptic contact: semi-axis_1 along x1, where the relative radius of curvature is radius_1.
struct HertzEllipse {
  double semi_axis_1;
  double semi_axis_2;
  double peak_pressure;
  double approach;
  double friction_arm;  ///< mean distance of the pressure from the axis: gross slip in torsion takes mu W
                        ///< times it
};

/// Gap x1^2/(2 R_1) + x2^2/(2 R_2) pressed by W. Exact (no approximation of the ellipticity): root of the
/// transcendental equation for the axis ratio. Throws std::domain_error unless all are positive and finite.
HertzEllipse hertz_ellipse(double load, double radius_1, double radius_2, double effective_modulus);

}  // namespace slipstick::analytic
