# Typical mistakes of contact programs, one substitution each, and the gates that must fail for them. FIND must occur in
# the file exactly once.
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/mutant.cmake")

# A convolution whose transforms are as long as the grid: offsets beyond half of it wrap around.
mutant(no_zero_padding
  FILE solver/elasticity/convolution.cpp
  FIND [[std::vector<double>& quadrant = quadrants[slot];]]
  REPLACE [[std::vector<double>& quadrant = quadrants[slot];
    const std::vector<double> open = quadrant;
    const Parity odd = parity(components_[slot]);
    for (Index i = 0; i < grid.n1; ++i) {
      for (Index j = 0; j < grid.n2; ++j) {
        const Index i0 = std::min(i, grid.n1 - i);
        const Index j0 = std::min(j, grid.n2 - j);
        quadrant[count(i * grid.n2 + j)] =
            (i0 == i ? 1 : odd.x1) * (j0 == j ? 1 : odd.x2) * open[count(i0 * grid.n2 + j0)];
      }
    }]]
  GATES full-64-twist full-64-contact-radius)

# The cross kernel is odd in both coordinates; here it is even.
mutant(k12_even
  FILE solver/elasticity/convolution.cpp
  FIND [[bool is_imaginary(Component component) {]]
  REPLACE [[Parity with_even_cross(Component c) { return c == Component::k12 ? Parity{1, 1} : parity(c); }
#define parity with_even_cross
bool is_imaginary(Component component) {]]
  GATES full-64-twist full-64-traction-averaged-l2)

# The cross kernel has the wrong sign on a quadrant with one traction field.
mutant(k12_sign_in_a_quadrant
  FILE solver/elasticity/mirrored_convolution.cpp
  FIND [[P::load(k11 + at + line) * P::load(plain + at + line) +]]
  REPLACE [[P::load(k11 + at + line) * P::load(plain + at + line) -]]
  GATES hertz-64-traction-l1)

# Shear instead of rotation: Eqs. (8), (9) as printed.
mutant(rotation_as_printed
  FILE solver/grid/packing.cpp
  FIND [[place, n) = x2.segment]]
  REPLACE [[place, n) = -x2.segment]]
  GATES full-64-twist full-64-traction-averaged-l2)

# Slip keeps the direction that the traction had when the cell began to slip: Eqs. (22), (23).
mutant(frozen_slip_directions
  FILE solver/step/tractions.cpp
  FIND [[if (scene.solver.method == Method::coulomb) {]]
  REPLACE [[if (scene.solver.method == Method::coulomb) {
    return solve_by_paper_method(*elastic.make(part.grid(), tangential_kernel()), problem,
                                 {.tolerance = scene.solver.tolerance,
                                  .max_iterations = scene.solver.max_iterations,
                                  .progress = progress});
  }
  if (scene.solver.method == Method::coulomb) {]]
  GATES ellipse-64-slip-direction ellipse-64-gap ellipse-64-twist)

mutant(tolerance_times_ten
  FILE solver/scene/scene.cpp
  FIND [[scene.solver.tolerance = reader.number_or(]]
  REPLACE [[scene.solver.tolerance = 10.0 * reader.number_or(]]
  GATES paper-0.9-256-gap)

# Without the factor 2/pi in the stick area.
mutant(equation_1_as_printed
  FILE analytic/torsion.cpp
  FIND [[return profile.stick_traction(c, r, inward);]]
  REPLACE [[return pi / 2 * profile.stick_traction(c, r, inward);]]
  GATES full-64-traction-averaged-l2)

# Hertz's pressure at the corners of cells instead of their centres: the order of convergence falls.
mutant(pressure_at_corners
  FILE solver/scene/hertz_pressure.cpp
  FIND [[((cell_x1(grid) / contact.semi_axis_1).square() + (cell_x2(grid) / contact.semi_axis_2).square());]]
  REPLACE [[(((cell_x1(grid) + 0.5 * grid.h1) / contact.semi_axis_1).square() +
             ((cell_x2(grid) + 0.5 * grid.h2) / contact.semi_axis_2).square());]]
  GATES hertz-64-traction-l1 hertz-order-traction-l1 hertz-order-traction-l1-verdict)

# Masing's rule with a factor of 1.999 instead of 2.
mutant(masing_less_than_twice
  FILE analytic/cycle.cpp
  FIND [[.weight = std::copysign(2, change)]]
  REPLACE [[.weight = std::copysign(1.999, change)]]
  GATES fretting_torsion-128-unloaded-twist)

# The dissipated energy uses the friction bound of the previous step.
mutant(dissipated_against_the_old_pressure
  FILE solver/step/describe_step.cpp
  FIND [[const ArrayXd& bound = loads.problem.friction_bound;]]
  REPLACE [[static ArrayXd kept;
  const ArrayXd bound = kept.size() == 0 ? loads.problem.friction_bound : kept;
  kept = loads.problem.friction_bound;]]
  GATES growing_load-128-released-dissipated)

# The exact twist is off by less than the error of any mesh.
mutant(exact_twist_off_by_1e_9
  FILE analytic/torsion.cpp
  FIND [[return twist_integral / (2 * profile.load());]]
  REPLACE [[return (1 + 1e-9) * twist_integral / (2 * profile.load());]]
  GATES paper-0.9-exact-twist cone-0.9-exact-twist)
