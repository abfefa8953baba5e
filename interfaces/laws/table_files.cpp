// The law as tables and parameters: CSV, LAMMPS, Abaqus, MuJoCo, Drake.

#include <fmt/core.h>

#include "analytic/cycle.hpp"
#include "interfaces/laws/law_files.hpp"

namespace slipstick::laws {

using namespace convergence;

namespace {

/// A state of the table in the law's units.
struct LawRow {
  double rotation;
  double moment;
  double energy_lost;  ///< by a cycle of this amplitude
  double energy;       ///< that went in on first loading: the loop of a cycle is that of Masing's rule
};

/// Relative, of energies in tables.
constexpr double kLossError = 1e-10;

LawRow law_row(const ContactLaw& law, const analytic::TorsionState& state) {
  const double unit = law.moment_unit() * law.rotation_unit();
  const double lost =
      state.twist > 0.0 ? analytic::energy_lost_per_cycle(state, *law.contact.profile, kLossError) : 0.0;
  return {.rotation = state.twist * law.rotation_unit(),
          .moment = state.moment * law.moment_unit(),
          .energy_lost = lost * unit,
          .energy = (lost + 4.0 * state.moment * state.twist) / 8.0 * unit};
}

/// As XML allows in a comment.
std::string comment(std::string text) {
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) text[at] = '_';
  return "<!--\n" + text + "-->\n";
}

}  // namespace

std::string csv_table(const ContactLaw& law) {
  std::string text = "rotation,moment,stick_ratio,tangent_stiffness,energy_lost_per_cycle\n";
  for (const analytic::TorsionState& state : law.table.rows) {
    const LawRow row = law_row(law, state);
    text +=
        fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", row.rotation, row.moment, state.stick_ratio,
                    state.tangent_stiffness * law.moment_unit() / law.rotation_unit(), row.energy_lost);
  }
  return text;
}

std::string lammps_table(const ContactLaw& law) {
  const LammpsTwisting twisting = lammps_twisting(law);
  const StateTable table = tabulate_evenly(*law.contact.profile, law.table.error);
  const std::size_t count = table.rows.size();
  std::string text = law_heading(law, "# ");
  text += fmt::format(
      "# First loading, in the format of bond_style table: rotation, energy, -moment. With bond_style table "
      "linear\n"
      "# {1}, or spline {1}, LAMMPS takes these rows as they are, and the moment is within {0:.2g} of the "
      "limit; with\n"
      "# fewer values than rows it is not. It has no unloading. Parameters for pair_style granular:\n"
      "#   twisting sds {2:.10g} 0.0 {3:.10g}\n"
      "# has the exact limit and misses the moment by {4:.1f} % of it at most; twisting marshall has a limit "
      "that is\n"
      "# {5:+.1f} % off.\n\n",
      table.error, count, twisting.stiffness, twisting.arm, 100.0 * twisting.error,
      100.0 * twisting.marshall_cap_error);
  const double stiffness = law.moment_unit() / law.rotation_unit();
  text += fmt::format("{}_TWIST\nN {} FP {:.17g} {:.17g}\n\n", capital_prefix_of(law), count,
                      -table.rows.front().tangent_stiffness * stiffness,
                      -table.rows.back().tangent_stiffness * stiffness);
  int index = 0;
  for (const analytic::TorsionState& state : table.rows) {
    const LawRow row = law_row(law, state);
    text += fmt::format("{} {:.17g} {:.17g} {:.17g}\n", ++index, row.rotation, row.energy, -row.moment);
  }
  return text;
}

std::string abaqus_behaviours(const ContactLaw& law) {
  const std::string prefix = capital_prefix_of(law);
  std::string text = law_heading(law, "** ");
  text += fmt::format(
      "** {0}_LOADING: first loading, elastic; linear in between the moment is within {1:.2g} of the limit.\n"
      "** {0}_ELEMENT_1 to {2}: one connector each, side by side between the same two nodes. They lose "
      "energy\n"
      "** and follow Masing's rule, within {3:.2g} of the limit on first loading, {4:.2g} on loops between "
      "a\n"
      "** rotation and its negative, {5:.2g} after any rotations.\n"
      "** Component 4 is the rotation about the connector's first axis: the contact's normal.\n",
      prefix, law.table.error, law.elements.elements.size(), law.elements.error, 3.0 * law.elements.error,
      law.elements.history_error);
  text += fmt::format(
      "*CONNECTOR BEHAVIOR, NAME={}_LOADING, EXTRAPOLATION=CONSTANT\n"
      "*CONNECTOR ELASTICITY, COMPONENT=4, NONLINEAR\n",
      prefix);
  const auto& rows = law.table.rows;
  for (auto state = rows.rbegin(); state + 1 != rows.rend(); ++state) {
    const LawRow row = law_row(law, *state);
    text += fmt::format("{:.15g}, {:.15g}\n", -row.moment, -row.rotation);
  }
  for (const analytic::TorsionState& state : rows) {
    const LawRow row = law_row(law, state);
    text += fmt::format("{:.15g}, {:.15g}\n", row.moment, row.rotation);
  }
  const double limit = law.limit_moment();
  int index = 0;
  for (const auto& [stiffness, slip] : law.elements.elements) {
    text += fmt::format(
        "*CONNECTOR BEHAVIOR, NAME={}_ELEMENT_{}\n*CONNECTOR ELASTICITY, COMPONENT=4\n{:.15g}\n"
        "*CONNECTOR PLASTICITY, COMPONENT=4\n*CONNECTOR HARDENING, TYPE=ISOTROPIC\n{:.15g}, 0.\n",
        prefix, ++index, stiffness * limit / law.rotation_unit(), slip * limit);
  }
  return text;
}

std::string mujoco_default(const ContactLaw& law) {
  const MujocoFriction friction = mujoco_friction(law).value();
  return comment(law_heading(law, "  ") +
                 fmt::format(
                     "  The limit moment is exact at every normal load that keeps the contact radius. MuJoCo "
                     "has no presliding:\n  the contact turns by {:.3g} rad at 0.9 of the limit, the model "
                     "creeps instead. Under force and moment\n  together its ellipsoid is {:+.1f} % off at "
                     "worst.\n",
                     friction.lost_presliding, 100.0 * friction.combined_error)) +
         fmt::format(
             "<mujoco model=\"slipstick_law\">\n  <option cone=\"elliptic\"/>\n  <default>\n"
             "    <geom condim=\"4\" friction=\"{:.17g} {:.17g} 0\"/>\n  </default>\n</mujoco>\n",
             friction.sliding, friction.torsional);
}

std::string drake_model(const ContactLaw& law) {
  const DrakeHydroelastic drake = drake_hydroelastic(law).value();
  return "<?xml version=\"1.0\"?>\n" +
         comment(
             law_heading(law, "  ") +
             fmt::format(
                 "  The modulus makes the limit moment exact at this load, against a rigid half-space; at "
                 "half of it the limit\n  is {:+.1f} % off. There is no presliding: the contact turns by "
                 "{:.3g} rad at 0.9 of the limit.\n",
                 100.0 * drake.half_load_error, drake.lost_presliding)) +
         fmt::format(
             "<sdf version=\"1.7\" xmlns:drake=\"http://drake.mit.edu\">\n  <model name=\"slipstick_law\">\n"
             "    <link name=\"sphere\">\n      <collision name=\"contact\">\n"
             "        <geometry><sphere><radius>{:.17g}</radius></sphere></geometry>\n"
             "        <drake:proximity_properties>\n          <drake:compliant_hydroelastic/>\n"
             "          <drake:hydroelastic_modulus>{:.17g}</drake:hydroelastic_modulus>\n"
             "          <drake:mesh_resolution_hint>{:.6g}</drake:mesh_resolution_hint>\n"
             "          <drake:mu_dynamic>{:.17g}</drake:mu_dynamic>\n"
             "        </drake:proximity_properties>\n      </collision>\n    </link>\n  </model>\n</sdf>\n",
             *law.contact.units->sphere_radius, drake.modulus, 0.1 * drake.contact_radius, drake.mu_dynamic);
}

}  // namespace slipstick::laws
