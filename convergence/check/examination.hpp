#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/foreign_field.hpp"
#include "convergence/check/reference_on_grid.hpp"
#include "convergence/oracle/oracle.hpp"
#include "solver/contact/certificate.hpp"

namespace slipstick::convergence {

/// A field that another program computed for a scene, with all numbers that judge it. They are dimensionless
/// like those of `contact`; moments are over the cell area.
struct Examination {
  solver::Scene scene;
  Interpretation read;  ///< with the twist's convention
  OracleAnswer exact;   ///< its centre is that of the field's grid
  GivenContact contact;
  ReferenceOnGrid reference;
  bool constant_cells;           ///< pressure, and so traction too, is constant in each cell
  bool pressure_given;           ///< the user asked not to judge the pressure
  bool twist_given;              ///< by the user or by the scene
  State state;                   ///< under that twist, otherwise `fitted`
  State fitted;                  ///< under the motion that fits best
  Deviation deviation;           ///< from the right answer
  Eigen::ArrayXd stick;          ///< cells
  std::optional<double> moment;  ///< that the scene asks for; none: any
  double moment_limit;           ///< of the field's pressure
  solver::Certificate certificate;
  solver::SlipDirection direction;  ///< of noticeable slip
};

/// twist: the one that the program reported, in rad; none: the scene's, if it imposes one, or the one that
/// fits Coulomb's law best. pressure_given: the pressure is not judged. columns: as in read_foreign_field().
/// Throws InputError for a history, for a scene without friction, and where read_foreign_field() or
/// in_own_conventions() does; std::runtime_error where the reference's solve does not converge.
Examination examine(const solver::Scene& scene, const std::filesystem::path& file,
                    std::optional<double> twist, bool pressure_given = false,
                    const std::vector<std::string>& columns = {});

/// computed/exact - 1.
double relative_error(double value, double exact);

}  // namespace slipstick::convergence
