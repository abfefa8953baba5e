#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/diagnosis.hpp"
#include "convergence/check/examination.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// The largest values that a right field may have on its own mesh: errors of loads, motion and fields, all
/// relative, and distances from Coulomb's law.
struct Allowed {
  double normal, moment, force;
  double pressure;                ///< in the mean
  Eigen::ArrayXd pressure_cells;  ///< cells; empty: the pressure is not judged
  double motion;
  double tractions;               ///< in the mean
  double inside;                  ///< their part in inner cells
  Eigen::ArrayXd traction_cells;  ///< cells
  double friction;                ///< of |q|/(mu p) in the slip ring
  double friction_bound;          ///< of friction_excess()
  double direction;               ///< degrees
  double gap;                     ///< of Coulomb's law over the energy
  double discrete_gap;            ///< the same of a field that solves its own grid's problem
};

/// A number and its allowed maximum, which NaN exceeds.
struct Judged {
  std::string quantity;
  double value;
  double allowed;
  std::string right;  ///< words for the verdict where it holds; empty: none
  std::string wrong;  ///< and where it does not: the error, its place, the maximum; empty: none
  bool low = false;   ///< the quantity is too small, where its error has a sign

  bool holds() const { return value <= allowed; }
};

/// Two answers. Is the field right within its mesh? Pressure, loads, motion, tractions and Coulomb's law are judged in
/// the mean and cell by cell, against the errors of right fields of any discretisation on the same mesh, or against the
/// user's tolerance. Does it solve its own grid's problem, with constant tractions in each cell, up to iteration error?
struct Verdict {
  std::vector<Judged> judged;  ///< in the order in which one quantity follows from another
  Judged discrete;
  Allowed allowed;

  bool within_mesh() const;
  bool holds(const std::string& quantity) const;  ///< true, too, where it was not judged
};

/// Judges a field:
///
///  1. The errors that right fields of this mesh show, digits and noise of the file, and the quadrature of
///     the loads give the allowed maximum of each quantity. tolerance: replaces the mesh's errors in loads,
///     motion, pressure and tractions.
///  2. Normal load and pressure, moment and force are compared with the scene's.
///  3. |q| is compared with its bound, in the slip ring and in each cell.
///  4. Motion and tractions are compared with the right answer, slip directions and gap with the law.
Verdict reach_verdict(const Examination& examination, std::optional<double> tolerance);

/// The relative error of the moment that the scene imposes or its imposed twist causes. A scene's ratio may
/// refer to the exact limit moment, to the limit of the field's own pressure or, where the exact one is not
/// known, to the limit of the right pressure on a finer mesh. None: the moment is not known.
std::optional<double> moment_error(const Examination& examination);

/// Whether the scene has no tangential force and imposes no displacement.
bool is_torsion(const solver::Scene& scene);

/// "5.1 % too low".
std::string off_text(double error);

/// "a, b and c".
std::string listed(const std::vector<std::string>& parts);

/// The first sentence of a field that is right within its mesh.
std::string right_text(const Examination& examination, const Verdict& verdict);

/// The likely causes of a field's errors.
struct Explanation {
  std::optional<Diagnosis> diagnosis;  ///< of a field whose tractions, motion or law of friction are wrong
  std::vector<Cause> causes;           ///< mistakes without which the field would be good
};

/// Looks for causes in this order, and stops at the first that explains the field:
///
///  1. A wrong pressure: an infinite value that was sampled, rows that are missing, another scene's pressure
///     (each with one mistake in bodies or layers, solved on the field's cells).
///  2. A smaller load than the scene's: the tractions of a step before.
///  3. A wrong twist of right tractions: units, sign, compliance.
///  4. Another friction than the scene's, a wrong kernel, directions that slipping cells keep: diagnose().
Explanation explain(const Examination& examination, const Verdict& verdict);

/// A field that was checked.
struct FieldCheck {
  std::filesystem::path file;
  CheckOptions options;
  Examination examination;
  Verdict verdict;
  Explanation explanation;

  bool good() const;
  std::string headline() const;  ///< the first quantity that is wrong, or that all are right
  std::string details() const;   ///< the causes, further wrong quantities, the right ones
};

/// Judges a traction field that any program computed for a scene, by Coulomb's law and against the exact
/// solution where one exists:
///
///  1. examine(): read the field, put it into the scene's conventions, pose its contact, measure its errors
///     and the errors that its mesh causes in right fields.
///  2. reach_verdict(): compare each quantity with its allowed maximum.
///  3. explain(): name likely causes of wrong quantities.
///
/// Without a twist, the scene's is taken if it imposes one, otherwise the one that fits Coulomb's law best.
/// Throws InputError for a field or a scene that cannot be judged.
FieldCheck check_field(const solver::Scene& scene, const std::filesystem::path& file, const CheckOptions& options = {});

/// The result in SI units, docs/schema/check.schema.json.
Json to_json(const FieldCheck& check);

/// The result in a few lines of text.
std::string check_text(const FieldCheck& check);

}  // namespace slipstick::convergence
