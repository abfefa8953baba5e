#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/conventions.hpp"
#include "convergence/check/reference_on_grid.hpp"
#include "convergence/oracle/oracle.hpp"
#include "solver/contact/certificate.hpp"

namespace slipstick::convergence {

/// A field that some program computed for a scene, with all that is worked out about it. Dimensionless, as
/// its contact is; moments over the cell area.
struct Examination {
  solver::Scene scene;
  Interpretation read;
  std::vector<std::string> conventions;  ///< the field's, and that of its twist
  OracleAnswer exact;                    ///< its centre is that of the field's grid
  GivenContact contact;
  ReferenceOnGrid reference;
  bool constant_cells;  ///< the pressure is one of constant cells: so are the tractions, then
  bool pressure_given;  ///< it was not judged because the user said so
  bool twist_given;
  State state;                   ///< under the twist given or imposed, or else the one that fits
  State fitted;                  ///< under the motion that Coulomb's law fits best
  Deviation deviation;           ///< from the right answer
  Eigen::ArrayXd stick;          ///< cells
  std::optional<double> moment;  ///< asked for; none: any
  double moment_limit;           ///< of the field's pressure
  solver::Certificate certificate;
  solver::SlipDirection direction;  ///< of noticeable slip
};

/// twist: the one that the program reported, in rad; none: the scene's, if it imposes one, or the one that
/// Coulomb's law fits best. Throws InputError for what cannot be judged: a history, a scene without friction,
/// and what read_foreign_field() and in_own_conventions() refuse; std::runtime_error where the
/// reference's solve does not converge. pressure_given: it is not judged. columns: as
/// read_foreign_field().
Examination examine(const solver::Scene& scene, const std::filesystem::path& file,
                    std::optional<double> twist, bool pressure_given = false,
                    const std::vector<std::string>& columns = {});

/// computed/exact - 1.
double relative_error(double value, double exact);

}  // namespace slipstick::convergence
